// A pool of two devices: each loses its device at every submission in turn, and every request for host memory and
// threads fails in turn.
#include <new>

#include "faults/adopted.h"
#include "faults/scenario.h"
#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using test::Contains;
using test::FaultyHost;
using test::sameBits;
using test::VulkanFault;

struct TwoDevices {
  TwoDevices() {
    for (const FaultyHost* host : {&first, &second}) devices.push_back(Device::adopt(host->handles));
    test::SceneEdits().make(scene);
    Sweeper sweeper(devices[0], scene, kOptions);
    expected = queries.answersBy(sweeper);
  }
  Answers answersBy(Pool& pool) const {
    return queries.answersBy(
        [&](const std::vector<Query>& batch, Mode mode) { return Answers(pool.submit(batch, mode).get()); });
  }
  static constexpr SweeperOptions kOptions{.cpuBatch = 0};
  FaultyHost first{0}, second{1};
  std::vector<Device> devices;
  Scene scene;
  test::BothModes queries{test::contactQueries(60), test::sampledQueries(12)};
  Answers expected;
};

TwoDevices& twoDevices() {
  return test::onceInRun([] { return TwoDevices(); });
}

}  // namespace

TEST_CASE("if one device of a pool is lost at any submission, the other answers all, with the same bits") {
  TwoDevices& two = twoDevices();
  for (const FaultyHost* lost : {&two.first, &two.second}) {
    bool happened = true;
    for (int n = 0; happened; ++n) {
      CAPTURE(n);
      Pool pool(two.devices, two.scene, TwoDevices::kOptions);
      const VulkanFault fault(n, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost, lost->handles.device,
                              lost->handles.queue);
      for (int round = 0; round < 2; ++round) {
        const Answers answers = two.answersBy(pool);
        CHECK(answers.reasons.empty());
        CHECK(sameBits(answers, two.expected));
      }
      happened = fault.happened();
      const std::vector<PoolDevice> devices = pool.devices();
      CHECK(devices[lost == &two.first ? 1 : 0].retired.empty());
      const std::string& retired = devices[lost == &two.first ? 0 : 1].retired;
      if (!retired.empty()) CHECK_THAT(retired, Contains("VK_ERROR_DEVICE_LOST"));
      if (n == 30) break;  // how many chunks a device takes depends on their speeds
    }
  }
}

TEST_CASE("if both devices of a pool are lost at any submission, each answer is right or says so, and the pool ends") {
  TwoDevices& two = twoDevices();
  for (int n = 0; n < 12; ++n) {
    CAPTURE(n);
    Pool pool(two.devices, two.scene, TwoDevices::kOptions);
    const VulkanFault fault(n, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost);
    for (int round = 0; round < 2; ++round) {
      const Answers answers = two.answersBy(pool);
      for (size_t i = 0; i < answers.results.size(); ++i) {
        if (answers.results[i].status == Status::invalid) {
          CHECK_THAT(answers.reasons.at(i), Contains("VK_ERROR_DEVICE_LOST"));
        } else {
          CHECK(sameBits(answers.results[i], two.expected.results[i]));
        }
      }
    }
  }
}

TEST_CASE("whichever request of a pool's threads for memory fails, it throws or answers, and then answers again") {
  TwoDevices& two = twoDevices();
  const test::EngineWork counting;  // the pool's threads count, too
  Pool pool(two.devices, two.scene, TwoDevices::kOptions);
  two.answersBy(pool);
  int64_t requests = 0, thrown = 0;
  {
    test::host_memory::failAt(-1);
    two.answersBy(pool);
    requests = test::host_memory::requests();
  }
  CHECK(requests > 300);
  // Threads make their requests in no fixed order, and the same ones in every chunk.
  for (int64_t n = 0; n < requests; n += 1 + requests / 300) {
    bool threw = false;
    Answers answers;
    test::host_memory::failAt(n);
    try {
      answers = two.answersBy(pool);
    } catch (const std::bad_alloc&) {
      threw = true;
      ++thrown;
    }
    test::host_memory::failAt(-1);
    const test::OthersWork notCounting;
    CAPTURE(n);
    for (const PoolDevice& device : pool.devices()) CHECK(device.retired.empty());
    if (!threw) CHECK(sameBits(answers, two.expected));
    if (n % 8 == 0) CHECK(sameBits(two.answersBy(pool), two.expected));
  }
  CHECK(thrown > 50);
}

TEST_CASE("if a pool's threads cannot be started, its constructor says so, and ends those that were") {
  TwoDevices& two = twoDevices();
  bool failed = true;
  for (int64_t n = 0; failed; ++n) {
    CAPTURE(n);
    const test::EngineWork counting;
    test::host_memory::failAt(n);
    try {
      const Pool pool(two.devices, two.scene, TwoDevices::kOptions);
      failed = false;
    } catch (const std::bad_alloc&) {
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Contains("Pool: expected to start a thread for each device"));
    }
    test::host_memory::failAt(-1);
    if (n == 40) break;  // more requests come from threads that end at once
  }
}
