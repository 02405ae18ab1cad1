// What Recorders refuse: each refusal names what is wrong and records nothing, so the next recording is answered.
#include "contact/pass.h"
#include "embed/checks.h"
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using test::Contains;

/// A row of boxes and three sensors, a mesh with bounds, and a recorder.
struct Refusing {
  template <class Queries>
  void refuse(const Queries& queries, const std::string& why, const HostGeometry& geometry = {}) {
    CAPTURE(why);
    CHECK_THROWS_WITH(test::execute(recorder, queries, geometry), test::StartsWith("record: ") && Contains(why));
    CHECK_THROWS_WITH(recorder.prepare(queries, geometry), test::StartsWith("prepare: ") && Contains(why));
    test::checkSame(test::execute(recorder, good), expected);
  }
  void refuseMesh(const DeformedMesh& deformed, const std::string& why) {
    refuse(row.queries, "geometry: mesh " + why, {.meshes = {&deformed, 1}});
  }
  void refuseObjects(const MovedObjects& moved, const std::string& why) {
    refuse(row.queries, why, {.objects = {&moved, 1}});
  }
  /// The queries, with a change of the second.
  template <class Change>
  std::vector<Query> with(const Change& change) const {
    std::vector<Query> queries = row.queries;
    change(queries[1]);
    return queries;
  }
  test::Row row{3};
  MeshId mesh = test::addMesh(row.scene, test::triangle(), Bounds{{-2, -2, -2}, {2, 2, 2}});
  const std::vector<Query> good = row.queries;
  const std::vector<Result> expected = test::expectedOf(row.scene, good);
  Recorder recorder{test::device(), row.scene, {.queries = 3}};
  test::OnDevice host{std::vector<std::byte>(1024)};
  const VkBuffer buffer = host.get();
};

}  // namespace

TEST_CASE("a Recorder whose last recording has not been executed says so, until reset()") {
  Refusing all;
  CHECK_FALSE(all.recorder.answerCounts().isExecuted);
  gpu::Submission submission(test::device().impl(), false);
  const ObjectId moved[] = {1};
  const MovedObjects group{.transforms = all.buffer, .objects = moved};
  const HostGeometry geometries[] = {{}, {.objects = {&group, 1}}};
  for (const HostGeometry& geometry : geometries) {
    all.recorder.record(submission.begin(), all.good, geometry);
    CHECK_FALSE(all.recorder.answerCounts().isExecuted);
    CHECK(all.recorder.boundsViolation().empty());
    CHECK(all.recorder.needed().candidates == usualCandidates(3));
    CHECK_THROWS_WITH(all.recorder.read(), test::StartsWith("read: the last recording has not been executed"));
    const std::string why = ": the last recording has not been executed: wait for it, or reset()";
    CHECK_THROWS_WITH(test::execute(all.recorder, all.good), test::StartsWith("record" + why));
    CHECK_THROWS_WITH(all.recorder.prepare(all.good), test::StartsWith("prepare" + why));
    all.recorder.reset();
    CHECK(all.recorder.read().results.empty());
    test::checkSame(test::execute(all.recorder, all.good), all.expected);
    CHECK(all.recorder.answerCounts().isExecuted);
  }
}

TEST_CASE("record refuses queries that break their contract, or are too many, and names them") {
  Refusing all;
  all.refuse(all.with([](Query& query) { query.direction = {}; }), "query 1: direction");
  all.refuse(all.with([](Query& query) { query.mesh = 9; }), "query 1: sensor: mesh 9 does not exist");
  all.refuse(all.with([](Query& query) { query.hits = 2; }),
             "expected at most 0 searches past one object each (Capacity::searches), got ");
  all.refuse(std::vector<Query>(4, all.good[0]), "expected at most 3 queries, got 4");
}

TEST_CASE("what only the CPU answers is refused and named") {
  Refusing all;
  const auto refuse = [&](const auto& change, const std::string& what) {
    const std::vector<Query> queries = all.with(change);
    CHECK_FALSE(test::isRecordable(queries[1], all.row.scene));
    all.refuse(queries, "query 1: only the CPU answers " + what + ": ask a Sweeper");
  };
  refuse([](Query& query) { query.skipOverlapping = true; }, "skipOverlapping");
  refuse(
      [](Query& query) {
        tools::takeStep(query);
        query.turn = Turn{{0, 0, 1}, 1, {}};
      },
      "a turn");
  const auto close = [](const auto& change) {
    return [change](Query& query) {
      query.clearance = 0.5;
      change(query);
    };
  };
  const std::string others = "a clearance with ignoreLeaving, hits or a step";
  refuse(close([](Query& query) { query.hits = 2; }), others);
  refuse(close([](Query& query) { query.ignoreLeaving = true; }), others);
  refuse(close(tools::takeStep), others);
  CHECK(test::isRecordable(all.with(close([](Query&) {}))[1], all.row.scene));
  all.row.scene.setMotion(0, {0, 0, 1});
  CHECK_FALSE(test::isRecordable(all.good[0], all.row.scene));
  CHECK_THROWS_WITH(test::execute(all.recorder, all.good),
                    Contains("query 0: only the CPU answers a direction while objects move: ask a Sweeper"));
  CHECK_THROWS_WITH(test::execute(all.recorder, HostQueries{.buffer = all.buffer, .count = 1}),
                    Contains("record: queries: expected a scene in which no object has a motion"));
}

TEST_CASE("record refuses written queries that do not fit, and says why") {
  Refusing all;
  all.refuse(HostQueries{.count = 1}, "queries: expected a buffer");
  all.refuse(HostQueries{.buffer = all.buffer, .stride = 79, .count = 1}, "stride: expected at least 80 bytes, got 79");
  all.refuse(HostQueries{.buffer = all.buffer, .count = 4}, "queries: count: expected at most 3, got 4");
  all.refuse(HostQueries{.buffer = all.buffer, .stride = VkDeviceSize{1} << 40, .count = 2}, "maxStorageBufferRange");
}

TEST_CASE("record refuses bad geometry, and names what is wrong") {
  Refusing all;
  const VkBuffer buffer = all.buffer;
  all.refuseMesh({7, {.buffer = buffer}}, "7 does not exist");
  all.refuseMesh({all.mesh, {}}, "1: expected a buffer of positions");
  all.refuseMesh({all.mesh, {.buffer = buffer, .stride = 11}}, "1: stride: expected at least 12 bytes, got 11");
  all.refuseMesh({all.mesh, {.buffer = buffer, .format = VK_FORMAT_R8_UNORM}}, "1: format: expected");
  const DeformedMesh deformed{all.mesh, {.buffer = buffer}}, twice[] = {deformed, deformed};
  all.refuse(all.good, "meshes: expected each at most once", {.meshes = twice});
  const ObjectId missing[] = {9}, same[] = {1, 1}, one[] = {1}, both[] = {1, 2};
  all.refuseObjects({.transforms = buffer, .objects = missing}, "object 9 does not exist");
  all.refuseObjects({.transforms = buffer, .objects = same}, "objects: expected each at most once");
  all.refuseObjects({.objects = one}, "expected a buffer of transforms");
  all.refuseObjects({.transforms = buffer, .firstObject = 7, .count = 2}, "object 8 does not exist");
  all.refuseObjects({.transforms = buffer, .objects = one, .count = 1},
                    "objects: expected a list or a count, got both");
  const MovedObjects overlapping[] = {{.transforms = buffer, .firstObject = 2, .count = 2},
                                      {.transforms = buffer, .firstObject = 3, .count = 2}};
  all.refuse(all.good, "objects: expected each at most once", {.objects = overlapping});
  const auto refuseStride = [&](VkDeviceSize stride, const TransformLayout& layout, const std::string& why) {
    all.refuseObjects({.transforms = buffer, .stride = stride, .objects = both, .layout = layout}, why);
  };
  refuseStride(47, kRowMajor, "objects: stride: expected at least 48 bytes, got 47");
  refuseStride(59, kColumnMajor, "objects: stride: expected at least 60 bytes, got 59");
  refuseStride(64, {0xffffffffu, 4}, "objects: stride: expected at least 8589934606 bytes");
  for (const VkDeviceSize stride : {VkDeviceSize{1} << 40, VkDeviceSize{1} << 63, ~VkDeviceSize{0}}) {
    refuseStride(stride, kRowMajor, "bytes of the device's maxStorageBufferRange");
    const DeformedMesh far{all.mesh, {.buffer = buffer, .stride = stride}};
    all.refuse(all.good, "bytes of the device's maxStorageBufferRange", {.meshes = {&far, 1}});
  }
}
