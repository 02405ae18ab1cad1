// Searches recorded into a host's command buffers give a sweeper's answers, on the device and read back.
#include <map>

#include "embed/on_device.h"
#include "embed/renderer.h"
#include "support/catch.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::execute;
using test::kRoom;
using test::Renderer;
using test::Row;
using test::sameBits;

}  // namespace

TEST_CASE("recorded answers equal a sweeper's, on the device and read back", "[subgroups]") {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Sweeper sweeper(test::device(), scene);
  Renderer renderer(test::device());
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    const tools::Workload workload = tools::hardScene(family, 5, 0, kRoom.queries, tools::Company::mixed);
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); i += 7) queries[i].anyHit = true;

    renderer.record(recorder, queries);
    renderer.submitAndWait();
    const std::vector<Result> read = recorder.read().results, expected = sweeper.run(queries).results;
    size_t unresolved = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(family.name, i);
      CHECK(sameBits(read[i], expected[i]));
      unresolved += test::checkShaderResult(renderer.shaderResult(i), expected[i]);
    }
    if (test::device().doubles() && family.name == "convex") CHECK(unresolved <= 2);
  }
  CHECK(test::takeValidationMessages().empty());
}

namespace {

// Gives each query a kind of its own: how far, what counts, what takes part.
void vary(std::vector<Query>& queries, const Scene& scene, tools::Random& random) {
  for (Query& query : queries) {
    const auto one = [&](uint32_t of) { return random.below(of) == 0; };
    if (one(6)) query.distance = 0;
    if (one(6)) query.distance *= 100;
    query.anyHit = one(4);
    query.ignoreLeaving = one(4);
    if (query.ignoreLeaving && one(2)) query.slack = one(2) ? 0 : 1e-9;
    if (!query.ignoreLeaving && one(5)) query.clearance = 0.01 * tools::sensorSize(scene, query);
    if (one(5)) query.mask = random.below(4);  // 0: no object takes part
    for (int i = 0; one(2) && i < 8; ++i) {
      if (scene.objectLimit() > 0) query.exclude.push_back(random.below(scene.objectLimit()));
    }
  }
}

}  // namespace

TEST_CASE("all bits of recorded answers are those of a Sweeper on the device and on the CPU, for queries of any kind") {
  tools::Random random(61);
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Sweeper onDevice(test::device(), scene, {.cpuBatch = 0}), onCpu(test::device(), scene, {.cpuBatch = 1000});
  std::map<Status, size_t> seen;
  for (uint32_t round = 0; round < 12; ++round) {
    const tools::Workload workload = tools::makeWorkload(
        tools::Soups{.objects = 30, .sensors = kRoom.queries, .triangles = 20, .seed = 100 + round});
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = test::queriesOf(workload);
    if (round % 4 == 3) {  // an empty scene
      for (ObjectId id = 0; id < scene.objectLimit(); ++id) scene.removeObject(id);
      for (Query& query : queries) query.exclude.clear();
    }
    vary(queries, scene, random);
    std::erase_if(queries, [&](const Query& query) { return !validate(query, scene).empty(); });
    const std::vector<Result> read = execute(recorder, queries), device = onDevice.run(queries).results,
                              cpu = onCpu.run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(round, i, queries[i].clearance, queries[i].distance, queries[i].mask, read[i].flags, read[i].status);
      CHECK(sameBits(device[i], cpu[i]));
      ++seen[cpu[i].status];
      // The one exception that recorder.h names.
      if (queries[i].clearance > 0 && cpu[i].status == Status::overlap) {
        CHECK((read[i].status == Status::overlap && read[i].object == kNone));
      } else {
        CHECK(sameBits(read[i], cpu[i]));
      }
    }
  }
  for (const Status status : {Status::hit, Status::clear, Status::overlap}) CHECK(seen[status] > 5);
}

TEST_CASE("changes of the scene after the recording do not affect reading") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  gpu::Submission submission(test::device().impl(), false);
  const std::vector<Result> expected = Sweeper(test::device(), row.scene).run(row.queries).results;
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  for (ObjectId id = 0; id < 8; ++id) row.scene.removeObject(id);
  row.scene.removeMesh(row.mesh);
  const std::vector<Result> read = recorder.read().results;
  for (size_t i = 0; i < read.size(); ++i) CHECK(sameBits(read[i], expected[i]));
}

TEST_CASE("synchronization validation reports a host that leaves out the documented barrier") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  Renderer renderer(test::device());
  renderer.record(recorder, row.queries, false);
  renderer.submitAndWait();
  const std::vector<std::string> messages = test::takeValidationMessages();
  REQUIRE_FALSE(messages.empty());
  CHECK(messages[0].find("SYNC-HAZARD-READ-AFTER-WRITE") != std::string::npos);
  renderer.record(recorder, row.queries, true);
  renderer.submitAndWait();
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("record throws for a query that it cannot record, names its number and records nothing") {
  Row row(3);
  Recorder recorder(test::device(), row.scene, {.queries = 3});
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  const auto refused = [&](const char* why) {
    CHECK_THROWS_WITH(recorder.record(commands, row.queries), test::Contains(why));
  };
  row.queries[0].direction = {};
  refused("record: query 0: direction");
  row.queries[0].direction = {0, 0, 1};
  row.queries[1].mesh = 9;
  refused("record: query 1: sensor: mesh 9 does not exist");
  row.queries[1].mesh = row.mesh;
  row.queries[2].hits = 2;
  refused("record: expected at most 0 searches past one object each (Capacity::searches), got ");
  row.queries[2].hits = 1;
  recorder.record(commands, row.queries);
  submission.submitAndWait();
  CHECK(recorder.read().results[2].status == Status::hit);
  row.queries.push_back(row.queries[0]);
  refused("expected at most 3 queries, got 4");
}

TEST_CASE("a recorded query with a clearance is decided when it is read, but for what it is near at the start",
          "[subgroups]") {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Sweeper sweeper(test::device(), scene);
  size_t hits = 0, overlaps = 0;
  for (const char* family : {"convex", "near", "ties", "interlocking", "far pose"}) {
    const tools::Workload workload =
        tools::hardScene(tools::hardFamily(family), 7, 0, kRoom.queries, tools::Company::mixed);
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].clearance = (i % 3 == 0 ? 1e-3 : 0.05) * tools::sensorSize(scene, queries[i]);
      queries[i].anyHit = i % 7 == 0;
    }
    const std::vector<Result> read = execute(recorder, queries), expected = sweeper.run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(family, i, read[i].flags);
      CHECK(read[i].status == expected[i].status);
      if (expected[i].status == Status::overlap) {
        ++overlaps;
        CHECK((read[i].object == kNone && read[i].t == 0 && read[i].lo == 0 && read[i].hi == 0));
      } else {
        CHECK(sameBits(read[i], expected[i]));
        hits += expected[i].status == Status::hit;
      }
    }
  }
  CHECK(hits > 50);
  CHECK(overlaps > 20);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("after reset, a recording that never executed does not affect the next one") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), row.queries);  // never executed, since begin() starts again
  recorder.reset();
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  const std::vector<Result> read = recorder.read().results,
                            expected = Sweeper(test::device(), row.scene).run(row.queries).results;
  for (size_t i = 0; i < read.size(); ++i) CHECK(sameBits(read[i], expected[i]));
}

TEST_CASE("one recorder records batches of different sizes while the scene changes", "[subgroups]") {
  // No query, one, many and few again; objects are removed and added in between.
  Row row(30);
  Recorder recorder(test::device(), row.scene);
  Sweeper sweeper(test::device(), row.scene);
  size_t hits = 0;
  for (const size_t count : {0u, 1u, 30u, 2u, 29u}) {
    const std::span<const Query> queries = std::span(row.queries).first(count);
    const std::vector<Result> read = execute(recorder, queries), expected = sweeper.run(queries).results;
    REQUIRE(read.size() == count);
    for (size_t i = 0; i < count; ++i) {
      CAPTURE(count, i);
      CHECK(sameBits(read[i], expected[i]));
      hits += read[i].status == Status::hit;
    }
    row.scene.removeObject(static_cast<ObjectId>(count % 8));
    row.scene.addObject({row.mesh, {{1, 0, 0, 0.3 * double(count), 0, 1, 0, 0.1, 0, 0, 1, 6.0}}, ~0u});
  }
  CHECK(hits > 20);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("exclusions and masks apply to recordings as to sweepers") {
  Row row(12);
  row.scene.removeObject(3);
  row.scene.addObject({row.mesh, {{1, 0, 0, 3.3, 0, 1, 0, 0.2, 0, 0, 1, 3.5}}, 4u});
  for (uint32_t i = 0; i < row.queries.size(); ++i) {
    if (i % 3 == 0) row.queries[i].exclude = {7, 0, 2, 1};
    if (i % 3 == 1) row.queries[i].mask = 3;
  }
  // More exclusions than there is room for at first.
  for (ObjectId id = 0; id < 8; ++id) {
    for (int times = 0; times < 20; ++times) row.queries[2].exclude.push_back(id);
  }
  Recorder recorder(test::device(), row.scene, {.queries = 12});
  const std::vector<Result> read = execute(recorder, row.queries),
                            expected = Sweeper(test::device(), row.scene).run(row.queries).results;
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(i);
    CHECK(sameBits(read[i], expected[i]));
  }
  CHECK(read[2].status == Status::clear);
}
