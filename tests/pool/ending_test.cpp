// Cancelling, waiting, and pools that end with work queued.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <thread>

#include "pool/fixture.h"
#include "pool/work_queue.h"
#include "support/catch.h"
#include "support/endless.h"
#include "support/test_device.h"

using namespace radar;
using namespace test;

namespace {

bool isReady(const std::future<PoolAnswers>& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Checks that every answer is correct or invalid for `reason`; returns the number of invalid ones.
size_t countInvalid(const PoolAnswers& answers, std::span<const Result> expected, const std::string& reason) {
  REQUIRE(answers.results.size() == expected.size());
  size_t count = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    if (const auto found = answers.reasons.find(i); found != answers.reasons.end()) {
      CHECK(found->second == reason);
      CHECK(answers.results[i].status == Status::invalid);
      ++count;
    } else {
      CHECK(differences({&answers.results[i], 1}, expected.subspan(i, 1)) == 0);
    }
  }
  return count;
}

size_t allocatedBytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

size_t threadCount() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<size_t>(std::distance(begin(tasks), end(tasks)));
}

}  // namespace

TEST_CASE("cancelling a batch invalidates its queries that have no answer and leaves other batches alone") {
  const Boxes boxes(300);
  const std::vector<Result> expected = boxes.answers();
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  std::stop_source stopBegun, stopQueued;
  test::HeldWaits held;
  std::future<PoolAnswers> begun = pool.submit(boxes.queries, Mode::contact, stopBegun.get_token());
  std::future<PoolAnswers> queued = pool.submit(boxes.queries, Mode::contact, stopQueued.get_token());
  std::future<PoolAnswers> other = pool.submit(boxes.queries);
  held.await(2);
  CHECK_FALSE(isReady(begun));
  stopBegun.request_stop();
  stopQueued.request_stop();
  held.release();
  CHECK(countInvalid(begun.get(), expected, "cancelled") > 0);
  CHECK(countInvalid(queued.get(), expected, "cancelled") == 300);
  CHECK(countInvalid(other.get(), expected, "") == 0);
}

TEST_CASE("cancelling a batch ends the search that a device's thread is in") {
  const test::Endless endless;
  Pool pool(twoDevices(), endless.scene, {.cpuBatch = kNone - 1});
  std::stop_source stop;
  std::future<PoolAnswers> begun = pool.submit({endless.query}, Mode::contact, stop.get_token());
  Query aside = endless.query;
  aside.worldFromMesh.m[3] = 1000;
  CHECK(pool.submit({aside}).get().results[0].status == Status::clear);  // taken after the other
  stop.request_stop();
  CHECK(begun.get().reasons.at(0) == "cancelled");
}

TEST_CASE("after an edit, the futures of all earlier batches are ready") {
  const Boxes boxes(100);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  std::vector<std::future<PoolAnswers>> futures(5);
  for (auto& future : futures) future = pool.submit(boxes.queries);
  pool.edit([] {});
  for (const auto& future : futures) CHECK(isReady(future));
  pool.edit([] {});
}

TEST_CASE("a pool that is destroyed with work queued fulfils every future, with answers or as invalid") {
  const Boxes boxes(300);
  const std::vector<Result> expected = boxes.answers();
  std::vector<std::future<PoolAnswers>> futures;
  test::HeldWaits held;
  std::jthread releasing;  // declared before the pool, whose destructor waits for release()
  {
    Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
    for (int i = 0; i < 4; ++i) futures.push_back(pool.submit(boxes.queries));
    held.await(2);
    releasing = std::jthread([&] {
      futures.back().wait();  // the destructor has closed the queue
      held.release();
    });
  }
  const size_t first = countInvalid(futures[0].get(), expected, "the pool was closed");
  CHECK(first > 0);
  CHECK(first < 300);
  for (int i = 1; i < 4; ++i) CHECK(countInvalid(futures[i].get(), expected, "the pool was closed") == 300);
}

TEST_CASE("creating, using and destroying a thousand pools leaks no thread and no memory") {
  const Boxes boxes(64);
  // Without the validation layers, which allocate memory of their own.
  const char* layers = std::getenv("VK_INSTANCE_LAYERS");
  const std::string restored = layers == nullptr ? "" : layers;
  unsetenv("VK_INSTANCE_LAYERS");
  const std::vector<Device> devices = openDevices(test::testedDevices());
  setenv("VK_INSTANCE_LAYERS", restored.c_str(), 1);
  const auto cycle = [&](int count) {
    for (int i = 0; i < count; ++i) {
      Pool pool(devices, boxes.player.scene(), test::kOnDevice);
      std::future<PoolAnswers> answers = pool.submit({boxes.queries[1 + i % 2]});
      if (i % 100 == 0) answers.wait();  // the other pools are destroyed with the query queued or in flight
    }
  };
  // A driver keeps allocations for its first pipelines, so all devices answer queries before the count.
  for (bool all = false; !all;) {
    Pool pool(devices, boxes.player.scene(), test::kOnDevice);
    pool.submit(boxes.queries).wait();
    all = std::ranges::all_of(pool.devices(), [](const auto& device) { return device.queries > 0; });
  }
  cycle(101);
  const size_t threads = threadCount(), before = allocatedBytes();
  cycle(1000);
  CHECK(threadCount() == threads);
  // 2 kB per pool; a single leaked buffer with its memory is larger.
  CHECK(allocatedBytes() < before + 2'000'000);
}

TEST_CASE("an edit waits for the chunks of a batch that ended for lack of memory") {
  // The batch was no longer open, so the scene changed while another device's worker was searching it.
  Scene scene;
  const MeshId mesh = scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<uint32_t>{0, 1, 2});
  WorkQueue queue(std::vector<PoolDevice>(2));
  std::future<PoolAnswers> answers = queue.post(
      std::vector<Query>(64, {.mesh = mesh, .direction = {0, 0, 1}, .distance = 1}), Mode::contact, {}, scene);
  const std::optional<Chunk> first = queue.take(0, 0), second = queue.take(1, 0);
  REQUIRE((first && second));
  const std::exception_ptr shortage = std::make_exception_ptr(std::bad_alloc());
  queue.abandon(*first, shortage);
  CHECK_THROWS_AS(answers.get(), std::bad_alloc);
  std::atomic<bool> begins = false, ended = false;
  const std::jthread other([&] {
    begins.wait(false);
    ended = true;
    queue.abandon(*second, shortage);
  });
  begins = true;
  begins.notify_one();
  queue.edit([&] { CHECK(ended); });
}
