// Searches recorded into a host's command buffers give a sweeper's answers, on the device and read back.
#include "embed/checks.h"
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "fuzz/check_recorded.h"
#include "support/small_scenes.h"

using namespace radar;
using namespace test;

TEST_CASE("recorded answers equal a sweeper's, on the device and read back", "[subgroups]") {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Sweeper sweeper(test::device(), scene);
  Renderer renderer(test::device());
  fuzz::Outcomes outcomes;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    CAPTURE(family.name);
    const tools::Workload workload = tools::hardScene(family, 5, 0, kRoom.queries, tools::Company::mixed);
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].anyHit = i % 7 == 0;
      if (i % 8 == 3) queries[i].mask = 1;
      if (i % 8 == 5) queries[i].exclude = {0, 3, 1, 3};
      if (i % 6 == 2 && !family.ignoresLeaving) queries[i].clearance = 0.05 * tools::sensorSize(scene, queries[i]);
    }
    renderer.record(recorder, queries);
    renderer.submitAndWait();
    const Answers read = recorder.read(), expected = sweeper.run(queries);
    fuzz::checkRecorded(queries, read, expected, outcomes);
    size_t unresolved = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(i);
      CHECK(read.results[i].tier == expected.results[i].tier);
      if (queries[i].clearance == 0) {
        unresolved += test::checkShaderResult(renderer.shaderResult(i), expected.results[i]);
      }
    }
    if (test::device().doubles() && family.name == "convex") CHECK(unresolved <= 2);
  }
  CHECK(outcomes.areExact());
}

TEST_CASE("a recorded point with a clearance is a ball, whatever its size, and heeds its tolerance") {
  Scene scene;
  const std::vector<float> corners(9, 0.0f);
  const std::vector<uint32_t> triangle{0, 1, 2};
  const MeshId point = scene.addMesh(corners, triangle), box = test::addBox(scene);
  for (int i = -2; i <= 2; ++i) scene.addObject({.mesh = box, .worldFromMesh = test::at(3.0 * i, 0, 40)});
  std::vector<Query> queries;
  for (const double radius : {1e-3, 0.25, 3.0, 30.0}) {
    for (const std::optional<double> tolerance : {std::optional<double>(), std::optional(1e-9)}) {
      queries.push_back(
          {.mesh = point, .worldFromMesh = test::at(0.1, 0.2, 0), .direction = {0, 0, 1}, .distance = 100});
      queries.back().clearance = radius;
      queries.back().tolerance = tolerance;
    }
  }
  Recorder recorder(test::device(), scene, kRoom);
  const std::vector<Result> read = test::execute(recorder, queries);
  test::checkSame(read, test::expectedOf(scene, queries));
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    const double radius = queries[i].clearance, contact = 39.5 - radius;
    CHECK(read[i].status == Status::hit);
    CHECK(read[i].lo <= contact + 1e-13);
    CHECK(read[i].hi >= contact - 1e-13);
    CHECK(read[i].hi - read[i].lo <= queries[i].tolerance.value_or(1e-6 * radius));
  }
}

TEST_CASE("changes of the scene after the recording do not affect reading") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  gpu::Submission submission(test::device().impl(), false);
  const std::vector<Result> expected = test::expectedOf(row.scene, row.queries);
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  for (ObjectId id = 0; id < 8; ++id) row.scene.removeObject(id);
  row.scene.removeMesh(row.mesh);
  test::checkSame(recorder.read().results, expected);
}

TEST_CASE("synchronization validation reports a host that leaves out the documented barrier") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  Renderer renderer(test::device());
  for (const bool withBarrier : {false, true}) {
    renderer.record(recorder, row.queries, withBarrier);
    renderer.submitAndWait();
    test::checkHazard(!withBarrier);
  }
}
