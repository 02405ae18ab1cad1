// Lists of hits, and steps in which objects move, recorded into command buffers.
#include <algorithm>

#include "embed/host_world.h"
#include "embed/renderer.h"
#include "fuzz/check_recorded.h"
#include "gpu/barrier.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/random.h"

namespace {

using namespace radar;
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

Recorded check(Recorder& recorder, const std::vector<Query>& queries, const Answers& expected, fuzz::Outcomes& outcomes,
               const HostGeometry& geometry = {}) {
  Recorded recorded = execute(recorder, queries, geometry);
  fuzz::checkRecorded(queries, recorded, expected, outcomes);
  for (uint32_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    checkOnDevice(recorder, recorded, i);
  }
  return recorded;
}

}  // namespace

TEST_CASE("recorded lists and steps are a sweeper's, on the device and read back", "[subgroups]") {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  tools::Random random(1);
  fuzz::Outcomes ways, steps;
  size_t number = 0;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    CAPTURE(family.name);
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
    check(recorder, queries, CpuSweeper(scene).run(queries), moves ? steps : ways);
  }
  CHECK(ways.lacking() + steps.lacking() + ways.outOfRange + steps.outOfRange == 0);
  CHECK(ways.listed + steps.listed > 900);
  CHECK(steps.hits > 100);
}

TEST_CASE("objects that a host's buffers move during a step are met where they are then", "[subgroups]") {
  tools::Random random(2);
  fuzz::Outcomes outcomes;
  for (uint64_t round = 0; round < 8; ++round) {
    const tools::Workload workload =
        tools::hardScene(tools::hardFamily("convex"), 11, round * kRoom.queries, kRoom.queries, tools::Company::mixed);
    test::HostWorld world;
    tools::replaceBy(workload, 0, world.truth);
    std::vector<Query> queries = queriesOf(workload);
    tools::setMotions(workload, random, world.truth);
    for (size_t i = 0; i < queries.size(); ++i) {
      tools::takeStep(queries[i]);
      queries[i].hits = i % 2 == 0 ? kAllHits : 1;
    }
    test::hide(world, static_cast<uint32_t>(round), true);
    Recorder recorder(test::device(), world.scene, kRoom);
    check(recorder, queries, CpuSweeper(world.truth).run(queries), outcomes, world.geometry());
    REQUIRE(recorder.boundsViolation().empty());
  }
  CHECK(outcomes.lacking() + outcomes.outOfRange == 0);
  CHECK(outcomes.hits > 50);
}

TEST_CASE("a list whose searches lack room is invalid and says why, and its neighbours are answered") {
  auto [scene, queries] =
      test::caseOf(tools::hardScene(tools::hardFamily("interlocking"), 12, 0, kRoom.queries, tools::Company::mixed));
  queries[0].hits = kAllHits;
  Capacity small = kRoom;
  small.candidates = 4;
  Recorder recorder(test::device(), scene, small);
  fuzz::Outcomes outcomes;
  const Recorded recorded = check(recorder, queries, CpuSweeper(scene).run(queries), outcomes);
  CHECK(recorded.results[0].flags == Flag::candidates);
  CHECK(outcomes.answered > 0);
}
