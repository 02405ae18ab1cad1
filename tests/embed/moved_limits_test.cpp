// Objects that a host moves without bounds: lists and steps, what floats cannot hold, and what is far away.
#include <cmath>

#include "embed/moved_world.h"
#include "embed/written_queries.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"

namespace {

using namespace radar;
using test::append;
using test::execute;
using test::kRoom;
using test::MovedWorld;
using test::OnDevice;
using test::sameBits;

constexpr Capacity kForLists{
    .queries = 24, .candidates = 1u << 17, .rounds = 64, .unresolvedPairs = 1u << 16, .searches = 1u << 11};

/// A unit box at each place.
struct Boxes {
  explicit Boxes(std::initializer_list<std::array<double, 3>> places) {
    const tools::MeshData box = tools::makeBox({1, 1, 1});
    mesh = scene.addMesh(box.positions, box.indices);
    for (const auto& [x, y, z] : places) {
      objects.push_back(scene.addObject({mesh, {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}}, ~0u}));
    }
  }
  /// The first object goes to these rows.
  Result ask(Recorder& recorder, const Query& query, std::initializer_list<float> rows) {
    return ask(recorder, std::vector<Query>{query}, rows)[0];
  }
  template <class Queries>
  std::vector<Result> ask(Recorder& recorder, const Queries& queries, std::initializer_list<float> rows) {
    std::vector<std::byte> bytes;
    append<float>(bytes, rows);
    const OnDevice transforms(bytes);
    const MovedObjects moved{.transforms = transforms.get(), .objects = {objects.data(), 1}};
    return execute(recorder, queries, {.objects = {&moved, 1}});
  }
  Scene scene;
  MeshId mesh;
  std::vector<ObjectId> objects;
};

}  // namespace

TEST_CASE("if a transform is not finite, or floats cannot hold the object's box, every answer is invalid") {
  Boxes boxes({{0, 0, 5}, {40, 0, 5}});
  const std::vector<Query> queries{{.mesh = boxes.mesh, .direction = {0, 0, 1}, .distance = 20},
                                   {.mesh = boxes.mesh,
                                    .worldFromMesh = {{1, 0, 0, 40, 0, 1, 0, 0, 0, 0, 1, 0}},
                                    .direction = {0, 0, 1},
                                    .distance = 20}};
  Recorder recorder(test::device(), boxes.scene);
  const auto expectHits = [&] {
    const std::vector<Result> read = boxes.ask(recorder, queries, {1, 0, 0, 0, 0, 1, 0, 0.25f, 0, 0, 1, 8});
    CHECK(read[0].t == 7);
    CHECK(read[1].t == 4);
    CHECK(recorder.boundsViolation().empty());
  };
  const auto expectRefused = [&](std::initializer_list<float> rows) {
    for (const Result& result : boxes.ask(recorder, queries, rows)) {
      CHECK(result.status == Status::invalid);
      CHECK(result.flags == Flag::bounds);
    }
    CHECK(recorder.boundsViolation() == "object 0: its transform is not finite, or floats cannot hold its box");
  };
  expectHits();
  expectRefused({1, 0, 0, 0, 0, 1, 0, NAN, 0, 0, 1, 8});
  expectRefused({1, 0, 0, 0, 0, 1, INFINITY, 0, 0, 0, 1, 8});
  expectHits();
  expectRefused({1, 0, 0, 1e25f, 0, 1, 0, 0, 0, 0, 1, 8});
  expectRefused({1, 0, 0, 0, 0, 1e25f, 0, 0, 0, 0, 1, 8});
  expectRefused({1, 0, 0, 0, 0, 3e38f, 0, 0, 0, 0, 1, 8});
  expectHits();
  // Bounds count from the next recording on.
  boxes.scene.setBounds(boxes.objects[0], {{-0.6, -0.6, 4.4}, {0.6, 0.6, 5.6}});
  CHECK(boxes.ask(recorder, queries, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 8})[1].flags == Flag::bounds);
  CHECK(recorder.boundsViolation() == "object 0: its mesh's box is outside its bounds, or its transform is not finite");
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an object that a host moves as far away as a sensor can see is found along any direction") {
  // The sensor's path and a face of the object overlap by less than what the search loses on the way, for it raises the
  // velocity across.
  for (const int exponent : {20, 30, 34, 36}) {
    for (const float aside : {-0.99f, 0.99f}) {
      CAPTURE(exponent, aside);
      Boxes boxes({{0, 0, 5}, {3, 3, 3}, {-3, 3, 3}});
      const auto far = static_cast<float>(std::exp2(exponent));
      Query query{.mesh = boxes.mesh, .direction = {0, 0, 1}, .distance = 1e30};
      Recorder recorder(test::device(), boxes.scene);
      const std::initializer_list<float> there{1, 0, 0, aside, 0, 1, 0, 0.25f, 0, 0, 1, far};
      const std::vector<HostQuery> written{test::hostQueryOf(query)};
      CHECK(boxes.ask(recorder, query, there).t == std::exp2(exponent) - 1);
      CHECK(boxes.ask(recorder, written, there)[0].t == std::exp2(exponent) - 1);
    }
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a sensor too small for a scene that a host has spread gets Flag::range, and larger ones their answers") {
  Boxes boxes({{0, 0, 5}, {30, 0, 5}});
  std::vector<Query> queries;
  for (const double size : {0x1p-30, 1.0}) {
    queries.push_back({.mesh = boxes.mesh,
                       .worldFromMesh = {{size, 0, 0, 30, 0, size, 0, 0, 0, 0, size, 0}},
                       .direction = {0, 0, 1},
                       .distance = 20});
  }
  std::vector<HostQuery> written;
  written.reserve(queries.size());
  for (const Query& query : queries) written.push_back(test::hostQueryOf(query));
  queries.push_back(queries[1]);
  queries[2].clearance = 0x1p-8;
  Recorder recorder(test::device(), boxes.scene, kRoom);
  const std::initializer_list<float> near{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 8},
      far{1, 0, 0, 0x1p34f, 0, 1, 0, 0, 0, 0, 1, 8};
  for (const Result& result : boxes.ask(recorder, queries, near)) CHECK(result.status == Status::hit);
  const std::vector<Result> read = boxes.ask(recorder, queries, far);
  CHECK(read[0].flags == Flag::range);
  CHECK(read[1].t == 4);
  CHECK(read[2].flags == Flag::range);  // a clearance that is too small for that scene
  // As if the scene had been there.
  boxes.scene.setTransform(boxes.objects[0], {{1, 0, 0, 0x1p34, 0, 1, 0, 0, 0, 0, 1, 8}});
  const std::vector<Result> standing = execute(recorder, queries);
  CHECK(standing[1].t == 4);
  CHECK(standing[2].flags == Flag::range);
  CHECK(boxes.ask(recorder, written, near)[0].status == Status::hit);
  CHECK(boxes.ask(recorder, written, near)[1].t == 4);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("lists and steps search every object that a host moves without bounds, wherever the scene has it") {
  MovedWorld world(
      60, 14, {1, 7, 50}, [](ObjectId id) { return id % 3 != 0; }, [](ObjectId) { return false; });
  Recorder recorder(test::device(), world.scene, kForLists);
  size_t listed = 0, steps = 0;
  for (const bool moves : {false, true}) {
    std::vector<Query> queries = world.queries(20);
    for (Query& query : queries) {
      query.hits = world.random.oneIn(4) ? 1 : world.random.oneIn(2) ? 3 : kAllHits;
      query.anyHit = false;
      if (moves) {
        query.motion.emplace();
        for (size_t k = 0; k < 3; ++k) (*query.motion)[k] = query.direction[k];
        query.direction = {};
        query.distance = 0;
      }
    }
    for (ObjectId id = 0; moves && id < 60; id += 2) {
      const std::array<double, 3> motion = world.random.inCube(5);
      world.scene.setMotion(id, motion);
      world.truth.setMotion(id, motion);
    }
    gpu::Submission submission(test::device().impl(), false);
    recorder.record(submission.begin(), queries, world.geometry());
    submission.submitAndWait();
    const Answers read = recorder.read(), expected = CpuSweeper(world.truth).run(queries);
    for (uint32_t i = 0; i < queries.size(); ++i) {
      const Result& result = read.results[i];
      Result wanted = expected.results[i];
      CAPTURE(moves, i, result.flags, result.t, wanted.t);
      wanted.tier = result.tier;
      CHECK(sameBits(result, wanted));
      steps += moves && wanted.status == Status::hit;
      if (queries[i].hits == 1) continue;
      const std::vector<Result>&found = read.lists[i].hits, &others = expected.lists[i].hits;
      REQUIRE(found.size() == others.size());
      for (size_t k = 0; k < found.size(); ++k)
        CHECK((found[k].object == others[k].object && found[k].t == others[k].t));
      listed += found.size();
    }
  }
  CHECK(listed > 30);
  CHECK(steps > 4);
  // Each of the objects takes a search for each list.
  Recorder small(test::device(), world.scene, {.queries = 24, .searches = 39});
  std::vector<Query> one = world.queries(1);
  one[0].motion.reset();
  one[0].hits = 2;
  one[0].mask = ~0u;
  one[0].exclude.clear();
  for (ObjectId id = 0; id < 60; ++id) world.scene.setMotion(id, {});
  gpu::Submission submission(test::device().impl(), false);
  CHECK_THROWS_WITH(small.record(submission.begin(), one, world.geometry()),
                    test::Contains("at most 39 searches past one object each"));
  CHECK(test::takeValidationMessages().empty());
}
