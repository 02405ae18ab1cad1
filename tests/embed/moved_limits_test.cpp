// Objects that a host moves without bounds: lists and steps, what floats cannot hold, and what is far away.
#include <cmath>

#include "embed/checks.h"
#include "embed/host_world.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using namespace test;

/// A unit box at each place, of which a host moves the first.
struct Boxes {
  explicit Boxes(std::initializer_list<std::array<double, 3>> places) {
    for (const auto& [x, y, z] : places)
      objects.push_back(scene.addObject({.mesh = mesh, .worldFromMesh = at(x, y, z)}));
  }
  template <class Queries>
  std::vector<Result> ask(Recorder& recorder, const Queries& queries, const Transform& pose) const {
    return execute(recorder, queries, test::HostFrame().move(objects[0], pose).geometry());
  }
  /// Along z, to meet a box beyond (x, 0, 0).
  Query query(double x = 0, double distance = 20) const {
    return {.mesh = mesh, .worldFromMesh = at(x, 0, 0), .direction = {0, 0, 1}, .distance = distance};
  }
  Scene scene;
  MeshId mesh = test::addBox(scene);
  std::vector<ObjectId> objects;
};

}  // namespace

TEST_CASE("if a transform is not finite, or floats cannot hold the object's box, every answer is invalid") {
  Boxes boxes({{0, 0, 5}, {40, 0, 5}});
  const std::vector<Query> queries{boxes.query(), boxes.query(40)};
  Recorder recorder(test::device(), boxes.scene);
  const std::string unfit = "object 0: its transform is not finite, or floats cannot hold its box",
                    outside = "object 0: its mesh's box is outside its bounds, or its transform is not finite";
  const Transform good = at(0, 0.25, 8);
  const auto check = [&](size_t entry, double value, const std::string& violation) {
    CAPTURE(entry, value);
    Transform pose = good;
    pose.m[entry] = value;
    const std::vector<Result> read = boxes.ask(recorder, queries, pose);
    CHECK(recorder.boundsViolation() == violation);
    if (violation.empty()) {
      CHECK(read[0].t == 7);
      CHECK(read[1].t == 4);
    } else {
      for (const Result& result : read) CHECK(test::isRefused(result, Flag::bounds));
    }
  };
  check(0, 1, "");
  check(7, NAN, unfit);
  check(6, INFINITY, unfit);
  check(0, 1, "");
  check(3, 1e25, unfit);
  check(5, 1e25, unfit);
  check(5, 3e38, unfit);
  check(0, 1, "");
  // Bounds count from the next recording on.
  boxes.scene.setBounds(boxes.objects[0], {{-0.6, -0.6, 4.4}, {0.6, 0.6, 5.6}});
  check(0, 1, outside);
}

TEST_CASE("an object that a host moves as far away as a sensor can see is found along any direction") {
  // The sensor's path and a face of the object overlap by less than what the search loses on the way, for it raises the
  // velocity across.
  for (const int exponent : {20, 30, 34, 36}) {
    for (const double aside : {-0.99, 0.99}) {
      CAPTURE(exponent, aside);
      const Boxes boxes({{0, 0, 5}, {3, 3, 3}, {-3, 3, 3}});
      const test::Written written(std::vector<Query>{boxes.query(0, 1e30)});
      Recorder recorder(test::device(), boxes.scene);
      const Transform there = at(aside, 0.25, std::exp2(exponent));
      CHECK(boxes.ask(recorder, written.same, there)[0].t == std::exp2(exponent) - 1);
      CHECK(boxes.ask(recorder, written, there)[0].t == std::exp2(exponent) - 1);
    }
  }
}

TEST_CASE("in a scene that a host has spread, queries get the answers, and flags, as if it had been there") {
  Boxes boxes({{0, 0, 5}, {30, 0, 5}});
  std::vector<Query> queries{boxes.query(30), boxes.query(30)};
  for (const size_t diagonal : {0, 5, 10}) queries[0].worldFromMesh.m[diagonal] = 0x1p-30;
  const test::Written written(queries);
  queries.push_back(queries[1]);
  queries[2].clearance = 0x1p-8;
  Recorder recorder(test::device(), boxes.scene, kRoom);
  const Transform near = at(0, 0, 8), far = at(0x1p34, 0, 8);
  for (const Result& result : boxes.ask(recorder, queries, near)) CHECK(result.status == Status::hit);
  const std::vector<Result> read = boxes.ask(recorder, queries, far);
  CHECK(read[0].t == 4.5 - 0x1p-31);
  CHECK(read[1].t == 4);
  CHECK(read[2].flags == Flag::range);  // a clearance that is too small for that scene
  // As if the scene had been there.
  boxes.scene.setTransform(boxes.objects[0], far);
  CHECK(test::differenceOf(execute(recorder, queries), read) == "");
  CHECK(boxes.ask(recorder, written, near)[0].status == Status::hit);
  CHECK(boxes.ask(recorder, written, near)[1].t == 4);
}

TEST_CASE("lists and steps search every object that a host moves without bounds, wherever the scene has it") {
  test::MovedWorld world(60, 14, {1, 7, 50}, [](ObjectId id) { return id % 3 != 0; });
  Recorder recorder(
      test::device(), world.scene,
      {.queries = 24, .candidates = 1u << 17, .rounds = 64, .unresolvedPairs = 1u << 16, .searches = 1u << 11});
  std::vector<Query> queries = world.queries(20);
  // Each of the objects takes a search for each list.
  Query list = queries[0];
  list.anyHit = false;
  list.hits = 2;
  list.mask = ~0u;
  list.exclude.clear();
  Recorder small(test::device(), world.scene, {.queries = 24, .searches = 39});
  gpu::Submission submission(test::device().impl(), false);
  CHECK_THROWS_WITH(small.record(submission.begin(), {&list, 1}, world.geometry()),
                    test::Contains("at most 39 searches past one object each"));
  fuzz::Outcomes ways, steps;
  const auto ask = [&](fuzz::Outcomes& outcomes) {
    for (Query& query : queries) {
      query.hits = world.random.oneIn(4) ? 1 : world.random.oneIn(2) ? 3 : kAllHits;
      query.anyHit = false;
    }
    test::ask(recorder, queries, world, outcomes);
    CHECK(outcomes.answered == queries.size());
    CHECK(outcomes.reordered == 0);
  };
  ask(ways);
  for (Query& query : queries) {
    query.motion = query.direction;
    query.direction = {};
    query.distance = 0;
  }
  for (ObjectId id = 0; id < 60; id += 2) {
    const std::array<double, 3> motion = world.random.inCube(5);
    for (Scene* scene : {&world.scene, &world.truth}) scene->setMotion(id, motion);
  }
  ask(steps);
  CHECK(ways.listed + steps.listed > 30);
  CHECK(steps.hits > 4);
}
