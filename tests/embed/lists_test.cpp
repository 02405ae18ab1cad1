// Lists of hits, and steps in which objects move, recorded into command buffers.
#include <cmath>

#include "embed/on_device.h"
#include "embed/renderer.h"
#include "gpu/barrier.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using test::OnDevice;
using test::queriesOf;
using test::sameBits;

constexpr Capacity kRoom{
    .queries = 24, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 17, .searches = 1u << 12};

struct Recorded : Answers {
  std::vector<Result> onDevice;  ///< answers and lists, before anything is decided
};

Recorded execute(Recorder& recorder, const std::vector<Query>& queries, const HostGeometry& geometry = {}) {
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  recorder.record(commands, queries, geometry);
  const uint32_t count = recorder.hitOffsets().back();
  gpu::Buffer readback(test::device().impl(), "results", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  readback.reserve(std::max<size_t>(count, 1) * sizeof(Result));
  gpu::computeWriteToCopy(commands);
  const VkBufferCopy region{0, 0, count * sizeof(Result)};
  commands->CmdCopyBuffer(commands, recorder.results(), readback.get(), 1, &region);
  gpu::copyToHost(commands);
  submission.submitAndWait();
  Recorded recorded{recorder.read(), {}};
  const auto* results = reinterpret_cast<const Result*>(readback.mapped());
  recorded.onDevice.assign(results, results + count);
  return recorded;
}

/// The same, but for the order of contacts that are less than a rounding apart.
bool agree(const Result& found, const Result& expected) {
  if (found.object == expected.object) return sameBits(found, expected);
  return found.status == expected.status && found.lo <= expected.hi && expected.lo <= found.hi;
}

/// Whether `onDevice` has the bits of what was read, but for an overlap's point, which only reading finds.
bool isAsRead(const Result& onDevice, Result read) {
  if (read.status == Status::overlap) read.point = Result().point;
  return sameBits(onDevice, read);
}

/// What the device left: the answer, or that it is open; and a list of the same order.
void checkOnDevice(const Recorder& recorder, const Recorded& recorded, uint32_t query) {
  const std::span<const uint32_t> offsets = recorder.hitOffsets();
  const auto list = std::span(recorded.onDevice).subspan(offsets[query], offsets[query + 1] - offsets[query]);
  const Result& answer = recorded.onDevice[query];
  const auto isOpen = [](const Result& result) { return result.flags == Flag::unresolved; };
  if (isOpen(answer)) {
    CHECK_FALSE(answer.lo > recorded.results[query].t);  // a decision has no t
  } else {
    CHECK(isAsRead(answer, recorded.results[query]));
  }
  if (std::any_of(list.begin(), list.end(), isOpen)) return;
  const std::span<const Result> read = test::listedBy(recorded, query).hits;
  REQUIRE(list.size() >= read.size());
  for (size_t k = 0; k < list.size(); ++k) {
    if (k < read.size()) CHECK(isAsRead(list[k], read[k]));
    if (k >= read.size()) CHECK(list[k].status == Status::clear);
  }
}

}  // namespace

TEST_CASE("recorded lists and steps are a sweeper's, on the device and read back", "[subgroups]") {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  CpuSweeper sweeper(scene);
  tools::Random random(1);
  size_t listed = 0, steps = 0, number = 0;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    const tools::Workload workload = tools::hardScene(family, 9, 0, kRoom.queries, tools::Company::mixed);
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = queriesOf(workload);
    const bool moves = number++ % 2 == 0;
    if (moves) tools::setMotions(workload, random, scene);
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].hits = i % 3 == 0 ? kAllHits : i % 3 == 1 ? 2 : 1;
      queries[i].anyHit = i % 6 == 2;
      if (moves || i % 2 == 0) tools::takeStep(queries[i]);
    }
    const Recorded recorded = execute(recorder, queries);
    Answers expected = sweeper.run(queries);
    for (uint32_t i = 0; i < queries.size(); ++i) {
      CAPTURE(family.name, i, moves, queries[i].hits);
      expected.results[i].tier = Tier::contact;
      CHECK(agree(recorded.results[i], expected.results[i]));
      const std::vector<Result>&found = recorded.lists[i].hits, &wanted = expected.lists[i].hits;
      REQUIRE(found.size() == wanted.size());
      for (size_t k = 0; k < found.size(); ++k) {
        Result hit = wanted[k];
        hit.tier = Tier::contact;
        CHECK(agree(found[k], hit));
      }
      checkOnDevice(recorder, recorded, i);
      listed += found.size();
      steps += moves && (recorded.results[i].status == Status::hit);
    }
  }
  CHECK(listed > 900);
  CHECK(steps > 100);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("objects that a host's buffers move during a step are met where they are then", "[subgroups]") {
  tools::Random random(2);
  size_t hits = 0;
  for (int round = 0; round < 8; ++round) {
    const tools::Workload workload = tools::hardScene(tools::hardFamily("convex"), 11, uint64_t(round) * kRoom.queries,
                                                      kRoom.queries, tools::Company::mixed);
    Scene scene;
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = queriesOf(workload);
    tools::setMotions(workload, random, scene);
    std::vector<std::byte> bytes;
    std::vector<ObjectId> objects;
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      if (!scene.hasObject(id)) continue;
      Transform pose = scene.object(id).worldFromMesh;
      for (double& entry : pose.m) {
        entry = static_cast<float>(entry);
        test::append(bytes, {static_cast<float>(entry)});
      }
      scene.setTransform(id, pose);
      objects.push_back(id);
    }
    for (size_t i = 0; i < queries.size(); ++i) {
      tools::takeStep(queries[i]);
      queries[i].hits = i % 2 == 0 ? kAllHits : 1;
    }
    CpuSweeper sweeper(scene);
    const Answers expected = sweeper.run(queries);
    // The scene's own poses are others; that the host's are within these bounds is all that it knows.
    for (const ObjectId id : objects) {
      Transform pose = scene.object(id).worldFromMesh;
      const std::array<double, 3> at{pose.m[3], pose.m[7], pose.m[11]};
      pose.m[3] += 2;
      scene.setTransform(id, pose);
      scene.setBounds(id, {{at[0] - 50, at[1] - 50, at[2] - 50}, {at[0] + 50, at[1] + 50, at[2] + 50}});
    }
    const OnDevice transforms(bytes);
    const MovedObjects moved{.transforms = transforms.get(), .objects = objects};
    Recorder recorder(test::device(), scene, kRoom);
    const Recorded recorded = execute(recorder, queries, {.objects = {&moved, 1}});
    REQUIRE(recorder.boundsViolation().empty());
    for (uint32_t i = 0; i < queries.size(); ++i) {
      CAPTURE(round, i);
      Result answer = expected.results[i];
      answer.tier = Tier::contact;
      CHECK(agree(recorded.results[i], answer));
      CHECK(recorded.lists[i].hits.size() == expected.lists[i].hits.size());
      checkOnDevice(recorder, recorded, i);
      hits += answer.status == Status::hit;
    }
  }
  CHECK(hits > 50);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("what only the CPU combines is refused and named, and nothing is recorded") {
  test::Row row(2);
  Recorder recorder(test::device(), row.scene, kRoom);
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  const auto refused = [&](const Query& query, const char* what) {
    CHECK_FALSE(test::isRecordable(query, row.scene));
    const std::vector<Query> queries{row.queries[0], query};
    CHECK_THROWS_WITH(
        recorder.record(commands, queries),
        test::Contains(std::string("record: query 1: only the CPU combines ") + what + ": ask a Sweeper"));
  };
  const Query plain = row.queries[1];
  Query query = plain;
  query.skipOverlapping = true;
  refused(query, "skipOverlapping");
  query = plain;
  query.clearance = 0.5;
  CHECK(test::isRecordable(query, row.scene));
  query.hits = 2;
  refused(query, "a clearance with ignoreLeaving, hits or a step");
  query.hits = 1;
  query.ignoreLeaving = true;
  refused(query, "a clearance with ignoreLeaving, hits or a step");
  query.ignoreLeaving = false;
  tools::takeStep(query);
  refused(query, "a clearance with ignoreLeaving, hits or a step");
  recorder.record(commands, row.queries);
  submission.submitAndWait();
  CHECK(recorder.read().results.size() == row.queries.size());
  row.scene.setMotion(0, {0, 0, 1});
  CHECK_THROWS_WITH(recorder.record(submission.begin(), {&plain, 1}),
                    test::Contains("record: query 0: only the CPU combines a direction while objects move: ask a "
                                   "Sweeper"));
  CHECK_FALSE(test::isRecordable(plain, row.scene));
}

TEST_CASE("a list whose searches lack room is invalid and says why, and its neighbours are answered") {
  const tools::Workload workload =
      tools::hardScene(tools::hardFamily("interlocking"), 12, 0, kRoom.queries, tools::Company::mixed);
  Scene scene;
  tools::replaceBy(workload, 0, scene);
  std::vector<Query> queries = queriesOf(workload);
  queries[0].hits = kAllHits;
  Capacity small = kRoom;
  small.candidates = 4;
  Recorder recorder(test::device(), scene, small);
  const Recorded recorded = execute(recorder, queries);
  CHECK(recorded.results[0].status == Status::invalid);
  CHECK(recorded.results[0].flags == Flag::candidates);
  CHECK(sameBits(recorded.onDevice[0], recorded.results[0]));
  const bool answersOthers = std::any_of(recorded.results.begin(), recorded.results.end(),
                                         [](const Result& result) { return result.status != Status::invalid; });
  CHECK(answersOthers);
}
