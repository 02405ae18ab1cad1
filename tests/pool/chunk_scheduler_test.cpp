// The sharing of work, simulated: devices of given speeds, two chunks in flight on each, no clock.
#include "pool/chunk_scheduler.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <deque>
#include <utility>

using radar::ChunkScheduler;

namespace {

/// Plays `batches` of `queries` each, all there from the start, on devices of `speeds` (queries per ms), and returns
/// the time of the whole over what the devices could do together.
double efficiency(const std::vector<double>& speeds, size_t queries, int batches = 1) {
  struct Worker {
    double free = 0;                                // when its device has done all it took
    std::deque<std::pair<double, size_t>> flights;  // when each ends, queries
    bool took = false;
  };
  ChunkScheduler share(speeds.size());
  std::vector<Worker> workers(speeds.size());
  double now = 0;
  for (int batch = 0; batch < batches; ++batch) {
    // As after an edit: the batch before has ended everywhere.
    size_t left = queries;
    for (;;) {
      bool took = true;
      while (took) {  // each takes what it may, in turns
        took = false;
        for (size_t i = 0; i < workers.size() && left > 0; ++i) {
          if (workers[i].flights.size() >= 2) continue;
          size_t inFlight = 0;
          for (const auto& [end, count] : workers[i].flights) inFlight += count;
          const size_t count = share.take(i, left, left, inFlight);
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
      share.finished(static_cast<size_t>(next - workers.begin()), count,
                     static_cast<double>(count) / speeds[static_cast<size_t>(next - workers.begin())]);
      now = end;
    }
    REQUIRE(left == 0);
    for (size_t i = 0; i < workers.size(); ++i) {
      if (!std::exchange(workers[i].took, false)) share.passed(i);
    }
  }
  double sum = 0;
  for (const double speed : speeds) sum += speed;
  return static_cast<double>(queries) * batches / (sum * now);
}

}  // namespace

TEST_CASE("devices of unequal speed end together: 85% and more of what they could do") {
  for (const double slow : {1.0, 0.7, 0.5, 0.25, 0.1, 0.03}) {
    CAPTURE(slow);
    CHECK(efficiency({1, slow}, 1000) > 0.97);
    CHECK(efficiency({slow, 1}, 1000) > 0.97);
    CHECK(efficiency({0.2, 0.2 * slow}, 30, 20) > 0.85);
    CHECK(efficiency({0.2 * slow, 0.2}, 30, 20) > 0.85);
    CHECK(efficiency({1, slow, 1, slow}, 1000) > 0.95);
  }
}

TEST_CASE("a device that was slow once takes part again after some batches") {
  ChunkScheduler share(2);
  share.finished(0, 1, 10);
  share.finished(1, 1, 1000);
  int batches = 0;
  while (share.take(1, 10, 10, 0) == 0) {
    share.passed(1);
    REQUIRE(++batches < 10);
  }
  CHECK(batches > 1);
}

TEST_CASE("fast devices take no crumbs: a chunk lasts a millisecond where there is that much") {
  ChunkScheduler share(2);
  share.finished(0, 1000, 1);
  share.finished(1, 1000, 1);
  CHECK(share.take(0, 100'000, 100'000, 0) > 10'000);
  CHECK(share.take(0, 3000, 3000, 0) == 1000);
  CHECK(share.take(0, 100, 100, 0) == 100);
}

TEST_CASE("the fastest device always takes, whatever is left, and so does the only one") {
  ChunkScheduler share(2);
  share.finished(0, 1, 100);
  share.finished(1, 1, 1);
  CHECK(share.take(1, 1, 1, 0) == 1);
  CHECK(share.take(0, 1, 1, 0) == 0);
  share.retire(1);
  CHECK(share.take(0, 1, 1, 0) == 1);
  CHECK(share.take(0, 1, 1, 5) == 1);
}
