// Devices that are lost or out of memory. The tests inject failures into the engine's calls of the queue and the
// allocator.
#include "pool/fixture.h"
#include "support/catch.h"

using namespace radar;
using test::Boxes;
using test::Contains;
using test::differences;
using test::faults;
using test::twoDevices;

namespace {

struct FaultReset {
  ~FaultReset() {
    for (size_t i : {0, 1}) faults(i).clear();
  }
};

}  // namespace

TEST_CASE("if a device is lost, the other takes over its chunks, and the answers name the lost device") {
  const Boxes boxes(400);
  for (const char* call : {"vkQueueSubmit2", "vkWaitForFences"}) {
    for (const int after : {0, 3}) {
      CAPTURE(call, after);
      const Mode mode = after == 0 ? Mode::contact : Mode::sampled;
      const std::vector<Result> expected = boxes.answers(mode);
      const FaultReset reset;
      Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
      faults(1).failFrom(call, after, VK_ERROR_DEVICE_LOST);
      const PoolAnswers answers = pool.submit(boxes.queries, mode).get();
      CHECK(differences(answers.results, expected) == 0);
      CHECK(answers.reasons.empty());
      // The first device may have finished everything before the second reaches the failing call.
      const std::string retired = pool.devices()[1].retired;
      if (after == 0 || !retired.empty()) {
        CHECK_THAT(retired, Contains(call) && Contains("VK_ERROR_DEVICE_LOST"));
        if (!answers.retired.empty()) CHECK_THAT(answers.retired[0], Contains("device 1") && Contains(retired));
      }
      CHECK(pool.devices()[0].retired.empty());
      CHECK(differences(pool.submit(boxes.queries, mode).get().results, expected) == 0);
    }
  }
}

TEST_CASE("a device that is out of memory is retired, and the other answers") {
  const Boxes boxes(200);
  const std::vector<Result> expected = boxes.answers();
  const FaultReset reset;
  faults(0).failFrom("vkAllocateMemory", 12, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  const PoolAnswers answers = pool.submit(boxes.queries).get();
  CHECK(differences(answers.results, expected) == 0);
  CHECK_THAT(pool.devices()[0].retired, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
}

TEST_CASE("the last device is kept if it is out of memory, and queries of mode contact are answered all the same") {
  const Boxes boxes(200);
  const std::vector<Result> expected = boxes.answers();
  for (const int after : {8, 12, 16, 20, 30}) {  // while the scene is uploaded or a batch is searched
    CAPTURE(after);
    const FaultReset reset;
    faults(0).failFrom("vkAllocateMemory", after, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    Pool pool(twoDevices().first(1), boxes.player.scene(), test::kOnDevice);
    for (const bool isOver : {false, true}) {
      if (isOver) faults(0).clear();
      const PoolAnswers answers = pool.submit(boxes.queries).get();
      CHECK(differences(answers.results, expected) == 0);
      CHECK(answers.reasons.empty());
      if (isOver) CHECK(answers.stats.submissions > 0);
    }
    CHECK(pool.devices()[0].retired.empty());
  }
}

TEST_CASE("with no device left, every query is invalid with the reasons, also in later batches") {
  const Boxes boxes(100);
  const FaultReset reset;
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  for (size_t i : {0, 1}) faults(i).failFrom("vkQueueSubmit2", 3, VK_ERROR_DEVICE_LOST);
  for (int round = 0; round < 100; ++round) {
    if (!pool.devices()[0].retired.empty() && !pool.devices()[1].retired.empty()) break;
    pool.submit(boxes.queries).wait();
  }
  const PoolAnswers answers = pool.submit(boxes.queries).get();
  for (size_t i = 0; i < boxes.queries.size(); ++i) {
    REQUIRE(answers.results[i].status == Status::invalid);
    REQUIRE_THAT(answers.reasons.at(i), Contains("no device is left") && Contains("device 0") && Contains("device 1") &&
                                            Contains("VK_ERROR_DEVICE_LOST"));
  }
  pool.edit([] {});
}

TEST_CASE("queries for which every device is out of memory are invalid, and one device stays in use") {
  Boxes boxes(30);
  const FaultReset reset;
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  const std::vector<Result> expected = boxes.answers(Mode::sampled);
  CHECK(differences(pool.submit(boxes.queries, Mode::sampled).get().results, expected) == 0);
  for (Query& query : boxes.queries) query.resolution = 256;  // needs larger images than have been allocated so far
  for (size_t i : {0, 1}) faults(i).failFrom("vkAllocateMemory", 0, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  const PoolAnswers answers = pool.submit(boxes.queries, Mode::sampled).get();
  CHECK_FALSE(answers.reasons.empty());
  for (const auto& [i, reason] : answers.reasons) {
    CHECK(answers.results[i].status == Status::invalid);
    CHECK_THAT(reason, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
  }
  for (size_t i : {0, 1}) faults(i).clear();
  CHECK(pool.submit(boxes.queries, Mode::sampled).get().reasons.empty());
  CHECK((pool.devices()[0].retired.empty() || pool.devices()[1].retired.empty()));
}
