// Devices that are lost or have no memory. Failures are made where the engine calls the queue and the allocator.
#include <catch2/catch.hpp>

#include "pool/fixture.h"

using namespace radar;
using Catch::Contains;
using test::Boxes;
using test::differences;
using test::faults;
using test::twoDevices;

namespace {

struct Mended {
  ~Mended() {
    for (size_t i : {0, 1}) faults(i).mend();
  }
};

}  // namespace

TEST_CASE("a device lost in the middle loses no query: the other does its chunks, and the answer says so") {
  const Boxes boxes(400);
  const std::vector<Result> expected = boxes.answers();
  for (const char* call : {"vkQueueSubmit2", "vkWaitForFences"}) {
    for (const int after : {0, 3}) {
      CAPTURE(call, after);
      const Mended mended;
      Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
      faults(1).failFrom(call, after, VK_ERROR_DEVICE_LOST);
      const PoolAnswers answers = pool.submit(boxes.queries).get();
      CHECK(differences(answers.results, expected) == 0);
      CHECK(answers.reasons.empty());
      // The first device may have done all before the second gets so far.
      const std::string retired = pool.devices()[1].retired;
      if (after == 0 || !retired.empty()) {
        CHECK_THAT(retired, Contains(call) && Contains("VK_ERROR_DEVICE_LOST"));
        if (!answers.retired.empty()) CHECK_THAT(answers.retired[0], Contains("device 1") && Contains(retired));
      }
      CHECK(pool.devices()[0].retired.empty());
      CHECK(differences(pool.submit(boxes.queries).get().results, expected) == 0);
    }
  }
}

TEST_CASE("a device without memory is retired, and the other answers") {
  const Boxes boxes(200);
  const std::vector<Result> expected = boxes.answers();
  const Mended mended;
  faults(0).failFrom("vkAllocateMemory", 30, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  const PoolAnswers answers = pool.submit(boxes.queries).get();
  CHECK(differences(answers.results, expected) == 0);
  CHECK_THAT(pool.devices()[0].retired, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
}

TEST_CASE("with no device left every query says why, now and later") {
  const Boxes boxes(100);
  const Mended mended;
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
  pool.drain();
}

TEST_CASE("queries for which no device has memory are invalid, and the last device stays for others") {
  Boxes boxes(30);
  const Mended mended;
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  const std::vector<Result> expected = boxes.answers();
  CHECK(differences(pool.submit(boxes.queries).get().results, expected) == 0);
  for (Query& query : boxes.queries) query.resolution = 256;  // needs larger pictures than there are yet
  for (size_t i : {0, 1}) faults(i).failFrom("vkAllocateMemory", 0, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  const PoolAnswers answers = pool.submit(boxes.queries).get();
  CHECK_FALSE(answers.reasons.empty());
  for (const auto& [i, reason] : answers.reasons) {
    CHECK(answers.results[i].status == Status::invalid);
    CHECK_THAT(reason, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
  }
  for (size_t i : {0, 1}) faults(i).mend();
  CHECK(pool.submit(boxes.queries).get().reasons.empty());
  CHECK((pool.devices()[0].retired.empty() || pool.devices()[1].retired.empty()));
}
