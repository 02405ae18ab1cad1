// A pool of two devices: each loses its device at every submission in turn or runs out of memory, and every request for
// host memory and threads fails in turn.
#include <new>

#include "faults/host_memory.h"
#include "faults/scenario.h"
#include "pool/fixture.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using namespace test;

struct Asked {
  Asked() {
    test::SceneEdits().make(scene);
    Sweeper sweeper(twoDevices()[0], scene, kOnDevice);
    expected = queries.answersBy(sweeper);
  }
  Answers answersBy(Pool& pool) const {
    return queries.answersBy(
        [&](const std::vector<Query>& batch, Mode mode) { return Answers(pool.submit(batch, mode).get()); });
  }
  Scene scene;
  test::BothModes queries{test::contactQueries(60), test::sampledQueries(12)};
  Answers expected;
};

const Asked& asked() {
  static const Asked one;
  return one;
}

const HostDevice& host(size_t device) {
  return device == 0 ? test::twoHosts().first.handles : test::twoHosts().second.handles;
}

bool isRetired(const PoolDevice& device) {
  return !device.retired.empty();
}

}  // namespace

TEST_CASE("if one device of a pool is lost at any submission, the other answers all, with the same bits") {
  const Asked& two = asked();
  for (const size_t lost : {0, 1}) {
    bool happened = true;
    for (int n = 0; happened && n < 30; ++n) {  // how many chunks a device takes depends on their speeds
      CAPTURE(n);
      Pool pool(twoDevices(), two.scene, kOnDevice);
      const VulkanFault fault(n, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost, {.device = &host(lost)});
      for (int round = 0; round < 2; ++round) {
        const Answers answers = two.answersBy(pool);
        CHECK(answers.reasons.empty());
        CHECK(sameBits(answers, two.expected));
      }
      happened = fault.happened();
      CHECK_FALSE(isRetired(pool.devices()[1 - lost]));
      const std::string retired = pool.devices()[lost].retired;
      CHECK(retired.empty() != happened);
      if (happened) CHECK_THAT(retired, Contains("VK_ERROR_DEVICE_LOST"));
    }
  }
}

TEST_CASE("the answers of a batch, and the pool, name a device that was lost, and the call that said so") {
  const Asked& two = asked();
  for (const char* call : {"vkQueueSubmit2", "vkWaitForFences"}) {
    Pool pool(twoDevices(), two.scene, kOnDevice);
    const VulkanFault fault(0, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost, {.device = &host(1), .name = call});
    const PoolAnswers answers = pool.submit(two.queries.contact).get();
    const std::string retired = pool.devices()[1].retired;
    CHECK_THAT(retired, Contains(call) && Contains("VK_ERROR_DEVICE_LOST"));
    REQUIRE(answers.retired.size() == 1);
    CHECK_THAT(answers.retired[0], Contains("device 1") && Contains(retired));
  }
}

TEST_CASE("if both devices of a pool are lost at any submission, the CPU answers mode contact") {
  const Asked& two = asked();
  for (const Device& device : twoDevices()) Sweeper(device, two.scene, kOnDevice);  // proves itself now
  const size_t contact = two.queries.contact.size();
  size_t bothLost = 0;
  for (int n = 0; n < 12; ++n) {
    CAPTURE(n);
    Pool pool(twoDevices(), two.scene, kOnDevice);
    const VulkanFault fault(n, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost);
    for (int round = 0; round < 2; ++round) {
      const Answers answers = two.answersBy(pool);
      for (size_t i = 0; i < answers.results.size(); ++i) {
        if (i >= contact && answers.results[i].status == Status::invalid) {
          CHECK_THAT(answers.reasons.at(i), Contains("VK_ERROR_DEVICE_LOST"));
        } else {
          CHECK(sameBits(answers.results[i], two.expected.results[i]));
        }
      }
    }
    if (!std::ranges::all_of(pool.devices(), isRetired)) continue;
    ++bothLost;
    const PoolAnswers onCpu = pool.submit(two.queries.contact).get();
    CHECK(onCpu.stats.cpuQueries == contact);
    CHECK_THAT(onCpu.stats.lost, Contains("VK_ERROR_DEVICE_LOST"));
    pool.edit([] {});
  }
  CHECK(bothLost > 0);
}

TEST_CASE("a device that is out of memory is retired, and the other answers") {
  const Asked& two = asked();
  const VulkanFault fault(12, VK_ERROR_OUT_OF_DEVICE_MEMORY, VulkanFault::When::onwards,
                          {.device = &host(0), .name = "vkAllocateMemory"});
  Pool pool(twoDevices(), two.scene, kOnDevice);
  CHECK(sameBits(two.answersBy(pool), two.expected));
  CHECK_THAT(pool.devices()[0].retired, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
}

TEST_CASE("the last device is kept if it is out of memory, and queries of mode contact are answered all the same") {
  const Asked& two = asked();
  const std::vector<Query>& queries = two.queries.contact;
  Sweeper sweeper(twoDevices()[0], two.scene, kOnDevice);
  const Answers expected = sweeper.run(queries);
  for (const int after : {8, 12, 16, 20, 30}) {  // while the scene is uploaded or a batch is searched
    CAPTURE(after);
    std::optional<VulkanFault> fault;
    fault.emplace(after, VK_ERROR_OUT_OF_DEVICE_MEMORY, VulkanFault::When::onwards,
                  test::FailingCalls{.device = &host(0), .name = "vkAllocateMemory"});
    Pool pool(twoDevices().first(1), two.scene, kOnDevice);
    for (const bool isOver : {false, true}) {
      if (isOver) fault.reset();
      const PoolAnswers answers = pool.submit(queries).get();
      CHECK(sameBits(answers, expected));
      CHECK(answers.reasons.empty());
      if (isOver) CHECK(answers.stats.submissions > 0);
    }
    CHECK_FALSE(isRetired(pool.devices()[0]));
  }
}

TEST_CASE("queries for which every device is out of memory are invalid, and one device stays in use") {
  const Asked& two = asked();
  std::vector<Query> queries = test::sampledQueries(30);
  Pool pool(twoDevices(), two.scene, kOnDevice);
  CHECK(pool.submit(queries, Mode::sampled).get().reasons.empty());
  for (Query& query : queries) query.resolution = 256;  // needs larger images than have been allocated so far
  {
    const VulkanFault fault(0, VK_ERROR_OUT_OF_DEVICE_MEMORY, VulkanFault::When::onwards, {.name = "vkAllocateMemory"});
    const PoolAnswers answers = pool.submit(queries, Mode::sampled).get();
    CHECK_FALSE(answers.reasons.empty());
    for (const auto& [i, reason] : answers.reasons) {
      CHECK(answers.results[i].status == Status::invalid);
      CHECK_THAT(reason, Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
    }
  }
  CHECK(pool.submit(queries, Mode::sampled).get().reasons.empty());
  CHECK_FALSE(std::ranges::all_of(pool.devices(), isRetired));
}

TEST_CASE("devices that lack memory to prove themselves leave mode contact to the CPU, and one stays in use") {
  const Asked& two = asked();
  const Answers expected = Sweeper(twoDevices()[0], two.scene, kOnDevice).run(two.queries.contact);
  Pool pool(twoDevices(), two.scene, kOnDevice);
  {
    const VulkanFault fault(0, VK_ERROR_OUT_OF_DEVICE_MEMORY, VulkanFault::When::onwards, {.name = "vkAllocateMemory"});
    CHECK_FALSE(pool.submit(test::sampledQueries(30), Mode::sampled).get().reasons.empty());
    CHECK(sameBits(pool.submit(two.queries.contact).get(), expected));
  }
  const PoolAnswers answers = pool.submit(two.queries.contact).get();
  CHECK(sameBits(answers, expected));
  CHECK(answers.stats.submissions > 0);
  CHECK(pool.submit(test::sampledQueries(30), Mode::sampled).get().reasons.empty());
  CHECK_FALSE(std::ranges::all_of(pool.devices(), isRetired));
}

TEST_CASE("whichever request of a pool's threads for memory fails, it throws or answers, and then answers again") {
  const Asked& two = asked();
  const test::EngineWork counting;  // the pool's threads count, too
  Pool pool(twoDevices(), two.scene, kOnDevice);
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
  const Asked& two = asked();
  bool failed = true;
  for (int64_t n = 0; failed; ++n) {
    CAPTURE(n);
    const test::EngineWork counting;
    test::host_memory::failAt(n);
    try {
      const Pool pool(twoDevices(), two.scene, kOnDevice);
      failed = false;
    } catch (const std::bad_alloc&) {
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Contains("Pool: expected to start a thread for each device"));
    }
    test::host_memory::failAt(-1);
    if (n == 40) break;  // more requests come from threads that end at once
  }
}
