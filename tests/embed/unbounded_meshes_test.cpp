// Searches of what a host deforms without bounds: with every option of a query, in turns with other geometry, and what
// is refused.
#include <cmath>
#include <deque>
#include <limits>

#include "embed/host_workload.h"
#include "embed/renderer.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "workloads/hard_cases.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::append;
using test::bufferOf;
using test::execute;
using test::HostWorkload;
using test::kRoom;
using test::OnDevice;
using test::sameBits;

}  // namespace

TEST_CASE("lists, steps, clearances and contacts at rest are those of the vertices that a host deforms without bounds",
          "[subgroups]") {
  Scene truth, scene;
  Recorder recorder(
      test::device(), scene,
      {.queries = 24, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 18, .searches = 8192});
  CpuSweeper reference(truth);
  tools::Random random(6);
  size_t answers = 0, hits = 0, listed = 0, refused = 0;
  uint32_t number = 0;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    const uint32_t seed = 400 + number++;
    tools::Workload workload = tools::hardScene(family, seed, 0, 24, tools::Company::mixed);
    const HostWorkload host(workload, seed, scene, false);
    tools::replaceBy(workload, 0, truth);
    std::vector<Query> queries = test::queriesOf(workload);
    const bool moves = number % 3 == 0;
    for (ObjectId id = 0; moves && id < workload.objectCount(0); ++id) {
      const std::array<double, 3> motion = random.inCube(2);
      truth.setMotion(id, motion);
      scene.setMotion(id, motion);
    }
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].anyHit = i % 7 == 2;
      const bool isPlain = !moves && i % 4 != 0;
      if (!isPlain) tools::takeStep(queries[i]);
      if (i % 3 == 0 && !queries[i].anyHit) queries[i].hits = i % 2 == 0 ? kAllHits : 2;
      if (isPlain && i % 3 != 0 && !queries[i].ignoreLeaving && !queries[i].anyHit) {
        queries[i].clearance = std::exp2(random.uniform(-10, -2));
        if (random.oneIn(2)) queries[i].tolerance = std::exp2(random.uniform(-20, -4));
      }
      queries[i].skipOverlapping = false;
    }
    const Answers got = execute(test::device(), recorder, queries, host.geometry());
    const Answers expected = reference.run(queries);
    for (uint32_t i = 0; i < queries.size(); ++i) {
      CAPTURE(family.name, seed, i, moves, queries[i].hits, queries[i].clearance, got.results[i].flags);
      ++answers;
      Result wanted = expected.results[i];
      wanted.tier = Tier::contact;
      if (got.results[i].status == Status::invalid || got.results[i].flags == Flag::unresolved) {
        // Without a tree for the deformed mesh, or as a clearance that doubles leave open.
        CHECK((got.results[i].flags & (Flag::unresolved | Flag::candidates | Flag::rounds)) != 0);
        ++refused;
        continue;
      }
      hits += wanted.status == Status::hit;
      if (queries[i].anyHit || got.results[i].object != wanted.object) {
        CHECK(got.results[i].status == wanted.status);
        CHECK_FALSE(wanted.lo > got.results[i].hi);
        if (!queries[i].anyHit) CHECK_FALSE(got.results[i].lo > wanted.hi);
      } else {
        CHECK(sameBits(got.results[i], wanted));
      }
      if (queries[i].hits == 1) continue;
      const std::vector<Result>&found = got.lists[i].hits, &others = expected.lists[i].hits;
      REQUIRE(found.size() == others.size());
      for (size_t k = 0; k < found.size(); ++k) {
        CHECK((found[k].lo <= others[k].hi && others[k].lo <= found[k].hi));
      }
      listed += found.size();
    }
  }
  CHECK(answers > 500);
  CHECK(hits > answers / 5);
  CHECK(listed > 300);
  CHECK(refused < answers / 20);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("meshes that a recording no longer deforms, and their objects, are the scene's again") {
  tools::Random random(12);
  Scene scene, truth;
  const tools::MeshData torus = tools::makeTorus(3, 1, 12, 8), box = tools::makeBox({1, 1, 1});
  std::vector<MeshId> meshes;
  for (int i = 0; i < 3; ++i) {
    meshes.push_back(scene.addMesh(torus.positions, torus.indices));
    truth.addMesh(torus.positions, torus.indices);
  }
  const MeshId sensor = scene.addMesh(box.positions, box.indices);
  truth.addMesh(box.positions, box.indices);
  std::vector<ObjectId> objects;
  for (uint32_t i = 0; i < 60; ++i) {
    Object object{meshes[i % 3], random.affine(random.inCube(30)), ~0u};
    for (double& x : object.worldFromMesh.m) x = static_cast<float>(x);
    objects.push_back(scene.addObject(object));
    truth.addObject(object);
  }
  SceneCopy copy(test::device(), scene);
  Recorder first(copy, kRoom), second(copy, kRoom);
  size_t hits = 0;
  for (int frame = 0; frame < 12; ++frame) {
    CAPTURE(frame);
    // Which meshes are deformed, by how much, and which objects are moved, changes from frame to frame.
    std::deque<OnDevice> buffers;
    std::vector<DeformedMesh> deformed;
    for (uint32_t i = 0; i < 3; ++i) {
      std::vector<float> positions = torus.positions;
      if (random.oneIn(2)) {
        const double scale = std::exp2(random.uniform(-6, 3));
        const tools::Vec3 at = random.inCube(random.oneIn(2) ? 0 : 100);
        for (size_t k = 0; k < positions.size(); ++k) {
          positions[k] = static_cast<float>(scale * positions[k] + 0.1 * random.uniform(-1, 1) + at[k % 3]);
        }
        buffers.push_back(bufferOf(positions));
        deformed.push_back({meshes[i], {.buffer = buffers.back().get()}});
      }
      truth.setPositions(meshes[i], positions);
    }
    std::vector<std::byte> bytes;
    std::vector<ObjectId> moved;
    for (const ObjectId id : objects) {
      Transform pose = scene.object(id).worldFromMesh;
      if (frame % 3 != 0 && random.oneIn(3)) {
        for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] = static_cast<float>(random.uniform(-30, 30));
        for (const double x : pose.m) append<float>(bytes, {static_cast<float>(x)});
        moved.push_back(id);
      }
      truth.setTransform(id, pose);
    }
    const OnDevice transforms(bytes.empty() ? std::vector<std::byte>(48) : bytes);
    const MovedObjects group{.transforms = transforms.get(), .objects = moved};
    HostGeometry geometry{.meshes = deformed};
    if (!moved.empty()) geometry.objects = {&group, 1};
    std::vector<Query> queries;
    for (uint32_t i = 0; i < 40; ++i) {
      Query query{.mesh = i % 3 == 0 ? sensor : meshes[i % 3], .direction = random.direction(), .distance = 60};
      query.worldFromMesh = random.affine(random.inCube(20));
      queries.push_back(query);
    }
    Recorder& recorder = frame % 2 == 0 ? first : second;
    const std::vector<Result> got = execute(recorder, queries, geometry),
                              expected = CpuSweeper(truth).run(queries).results;
    for (size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i, got[i].flags, got[i].t, expected[i].t, got[i].object, expected[i].object);
      Result wanted = expected[i];
      wanted.tier = got[i].tier;
      CHECK(sameBits(got[i], wanted));
      hits += wanted.status == Status::hit;
    }
    if (frame == 7) {
      // Not executed.
      gpu::Submission submission(test::device().impl(), false);
      first.record(submission.begin(), queries, geometry);
      first.reset();
    }
  }
  CHECK(hits > 100);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("of a mesh without bounds only finite vertices are taken, and those of triangles decide how large it is") {
  Scene scene;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // Vertices 2, 4 and 7 of the host's buffer are a triangle.
  const auto positions = [](float z, float other, float last) {
    std::vector<float> all(24, other);
    const float corners[] = {-1, -1, z, 1, -1, z, 0, 1, last};
    for (size_t i = 0; i < 9; ++i) all[3 * std::array<size_t, 3>{2, 4, 7}[i / 3] + i % 3] = corners[i];
    return all;
  };
  std::vector<std::byte> corners;
  append<uint16_t>(corners, {4, 2, 7});
  const OnDevice rest = bufferOf(positions(5, 1000, 5)), indices(corners);
  const MeshId wall = addMesh(scene, test::device(),
                              {.positions = {.buffer = rest.get()},
                               .vertexCount = 8,
                               .indices = indices.get(),
                               .indexType = VK_INDEX_TYPE_UINT16,
                               .indexCount = 3});
  scene.addObject({.mesh = wall});
  // Of this one, vertex 3 belongs to no triangle.
  const float quad[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 7, 7, 7};
  const uint32_t triangle[] = {0, 1, 2};
  const MeshId own = scene.addMesh(quad, triangle);
  scene.addObject({.mesh = own, .worldFromMesh = {{1, 0, 0, 40, 0, 1, 0, 0, 0, 0, 1, 6}}});
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  std::vector<Query> queries(
      2, {.mesh = scene.addMesh(box.positions, box.indices), .direction = {0, 0.001, 1}, .distance = 20});
  queries[1].worldFromMesh.m[3] = 40;
  Recorder recorder(test::device(), scene, kRoom);
  const auto answersAt = [&](const OnDevice& shared, const OnDevice& second) {
    const DeformedMesh deformed[] = {{wall, {.buffer = shared.get()}}, {own, {.buffer = second.get()}}};
    return execute(recorder, queries, {.meshes = deformed});
  };
  const auto ownAt = [&](float z, float unused) {
    return bufferOf(std::vector<float>{-1, -1, z, 1, -1, z, 0, 1, z, unused, unused, unused});
  };
  const auto expectHits = [&](float other, float unused) {
    const std::vector<Result> read = answersAt(bufferOf(positions(3, other, 3)), ownAt(1, unused));
    CHECK(read[0].t == Approx(2.5));
    CHECK(read[1].t == Approx(6.5));
    CHECK(recorder.boundsViolation().empty());
  };
  expectHits(0, 0);
  expectHits(nan, 1e35f);
  const auto expectRefused = [&](const std::vector<Result>& read, const std::string& why) {
    for (const Result& result : read) CHECK((result.status == Status::invalid && result.flags == Flag::bounds));
    CHECK(recorder.boundsViolation() == why);
  };
  expectRefused(answersAt(bufferOf(positions(3, 0, nan)), ownAt(1, 0)),
                "mesh 0: vertex 7 is not finite, or exceeds 2^120");
  expectRefused(answersAt(bufferOf(positions(3, 0, 3)), ownAt(1, nan)),
                "mesh 1: vertex 3 is not finite, or exceeds 2^120");
  expectRefused(answersAt(bufferOf(positions(3, 0, -3e38f)), ownAt(1, 0)),
                "mesh 0: vertex 7 is not finite, or exceeds 2^120");
  expectHits(0, 0);
  // Too large to be placed: the object leaves what floats can hold.
  expectRefused(answersAt(bufferOf(positions(1e30f, 0, 1e30f)), ownAt(1, 0)),
                "object 0: its transform is not finite, or floats cannot hold its box");
  CHECK(test::takeValidationMessages().empty());
}
