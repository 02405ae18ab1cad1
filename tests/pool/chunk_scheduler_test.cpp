// Simulates the chunk scheduler without a clock: devices of given speeds, two chunks in flight on each.
#include "pool/chunk_scheduler.h"
#include "support/catch.h"

#include <algorithm>
#include <deque>
#include <utility>

using radar::ChunkScheduler;

namespace {

/// Simulates `batches` of `queries` each, all queued from the start, on devices of `speeds` (queries per ms). Returns
/// the efficiency: the time that the devices would take together if none were ever idle, over the simulated time.
double efficiency(const std::vector<double>& speeds, size_t queries, int batches = 1) {
  struct Worker {
    double free = 0;                                // when its device has finished all its chunks
    std::deque<std::pair<double, size_t>> flights;  // end and number of queries of each chunk
    bool took = false;
  };
  ChunkScheduler scheduler(speeds.size());
  std::vector<Worker> workers(speeds.size());
  double now = 0;
  for (int batch = 0; batch < batches; ++batch) {
    // As after an edit, the previous batch has ended on all devices.
    size_t left = queries;
    for (;;) {
      bool took = true;
      while (took) {  // the workers take chunks in turn
        took = false;
        for (size_t i = 0; i < workers.size() && left > 0; ++i) {
          if (workers[i].flights.size() >= 2) continue;
          size_t inFlight = 0;
          for (const auto& [end, count] : workers[i].flights) inFlight += count;
          const size_t count = scheduler.take(i, left, left, inFlight);
          if (count == 0) continue;
          REQUIRE(count <= left);
          left -= count;
          workers[i].took = true;
          workers[i].free = std::max(now, workers[i].free) + static_cast<double>(count) / speeds[i];
          workers[i].flights.emplace_back(workers[i].free, count);
          took = true;
        }
      }
      auto next = workers.end();
      for (auto w = workers.begin(); w != workers.end(); ++w) {
        if (!w->flights.empty() && (next == workers.end() || w->flights.front().first < next->flights.front().first))
          next = w;
      }
      if (next == workers.end()) break;
      const auto [end, count] = next->flights.front();
      next->flights.pop_front();
      scheduler.finished(static_cast<size_t>(next - workers.begin()), count,
                         static_cast<double>(count) / speeds[static_cast<size_t>(next - workers.begin())]);
      now = end;
    }
    REQUIRE(left == 0);
    for (size_t i = 0; i < workers.size(); ++i) {
      if (!std::exchange(workers[i].took, false)) scheduler.passed(i);
    }
  }
  double sum = 0;
  for (const double speed : speeds) sum += speed;
  return static_cast<double>(queries) * batches / (sum * now);
}

}  // namespace

TEST_CASE("devices of unequal speed reach at least 85% of their combined throughput") {
  for (const double slow : {1.0, 0.7, 0.5, 0.25, 0.1, 0.03}) {
    CAPTURE(slow);
    CHECK(efficiency({1, slow}, 1000) > 0.97);
    CHECK(efficiency({slow, 1}, 1000) > 0.97);
    CHECK(efficiency({0.2, 0.2 * slow}, 30, 20) > 0.85);
    CHECK(efficiency({0.2 * slow, 0.2}, 30, 20) > 0.85);
    CHECK(efficiency({1, slow, 1, slow}, 1000) > 0.95);
  }
}

TEST_CASE("a device that was slow once gets work again after some batches") {
  ChunkScheduler scheduler(2);
  scheduler.finished(0, 1, 10);
  scheduler.finished(1, 1, 1000);
  int batches = 0;
  while (scheduler.take(1, 10, 10, 0) == 0) {
    scheduler.passed(1);
    REQUIRE(++batches < 10);
  }
  CHECK(batches > 1);
}

TEST_CASE("a chunk for a fast device lasts at least a millisecond if enough queries are left") {
  ChunkScheduler scheduler(2);
  scheduler.finished(0, 1000, 1);
  scheduler.finished(1, 1000, 1);
  CHECK(scheduler.take(0, 100'000, 100'000, 0) > 10'000);
  CHECK(scheduler.take(0, 3000, 3000, 0) == 1000);
  CHECK(scheduler.take(0, 100, 100, 0) == 100);
}

TEST_CASE("the fastest device and the only device left take even a single query") {
  ChunkScheduler scheduler(2);
  scheduler.finished(0, 1, 100);
  scheduler.finished(1, 1, 1);
  CHECK(scheduler.take(1, 1, 1, 0) == 1);
  CHECK(scheduler.take(0, 1, 1, 0) == 0);
  scheduler.retire(1);
  CHECK(scheduler.take(0, 1, 1, 0) == 1);
  CHECK(scheduler.take(0, 1, 1, 5) == 1);
}
