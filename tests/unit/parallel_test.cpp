// Parallel loops: each index once, no worker twice at a time, exceptions for the caller, threads that are shared.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <latch>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "scene/parallel.h"
#include "support/catch.h"

namespace {

using radar::parallelFor;
using radar::threadCount;

}  // namespace

TEST_CASE("a parallel loop visits each index once, in chunks of the given size") {
  const unsigned threads = GENERATE(0u, 1u, 2u, 5u);
  for (const size_t count : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    for (const size_t chunk : {1u, 7u, 64u, 5000u}) {
      std::vector<std::atomic<int>> visits(count);
      std::atomic<size_t> wrongChunks = 0;
      parallelFor(count, chunk, threads, [&](unsigned, size_t first, size_t last) {
        const bool right = first < last && first % chunk == 0 && last == std::min(count, first + chunk);
        wrongChunks += !right;
        for (size_t i = first; i < std::min(last, count); ++i) ++visits[i];
      });
      CAPTURE(threads, count, chunk);
      CHECK(wrongChunks == 0);
      CHECK(std::all_of(visits.begin(), visits.end(), [](const auto& n) { return n == 1; }));
    }
  }
}

TEST_CASE("a worker's number is below the number of threads, and calls with the same number do not overlap") {
  for (const unsigned threads : {1u, 2u, 4u, 0u}) {
    std::vector<std::atomic<bool>> busy(threadCount(threads));
    std::atomic<int> wrong = 0;
    parallelFor(400, 1, threads, [&](unsigned worker, size_t, size_t) {
      if (worker >= busy.size() || busy[worker].exchange(true)) {
        ++wrong;
        return;
      }
      for (int i = 0; i < 20; ++i) std::this_thread::yield();
      busy[worker] = false;
    });
    CAPTURE(threads);
    CHECK(wrong == 0);
  }
}

TEST_CASE("a loop on one thread runs on the caller's and takes the chunks in order") {
  std::vector<size_t> firsts;
  const auto caller = std::this_thread::get_id();
  parallelFor(100, 10, 1, [&](unsigned worker, size_t first, size_t) {
    CHECK(worker == 0);
    CHECK(std::this_thread::get_id() == caller);
    firsts.push_back(first);
  });
  CHECK(firsts == std::vector<size_t>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90});
}

TEST_CASE("several threads, the caller's among them, work at the same time") {
  // Each of four calls waits until all four have started: on fewer threads the test would hang.
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::latch there(4);
  parallelFor(4, 1, 4, [&](unsigned, size_t, size_t) {
    {
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
    }
    there.arrive_and_wait();
  });
  CHECK(threads.size() == 4);
  CHECK(threads.count(std::this_thread::get_id()) == 1);
}

TEST_CASE("an exception reaches the caller after all calls have ended") {
  const bool inCaller = GENERATE(true, false);
  std::atomic<int> running = 0;
  const auto caller = std::this_thread::get_id();
  const auto loop = [&] {
    std::latch areBothThere(2);
    std::once_flag callerCame, anotherCame;
    parallelFor(64, 1, 3, [&](unsigned, size_t, size_t) {
      ++running;
      const bool isCaller = std::this_thread::get_id() == caller;
      std::call_once(isCaller ? callerCame : anotherCame, [&] { areBothThere.count_down(); });
      areBothThere.wait();
      for (int i = 0; i < 20 && isCaller != inCaller; ++i) std::this_thread::yield();
      --running;
      if (isCaller == inCaller) throw std::runtime_error("thrown");
    });
  };
  CHECK_THROWS_WITH(loop(), "thrown");
  CHECK(running == 0);
}

TEST_CASE("loops share threads, also such as run at a time or within each other, and each comes to its end") {
  std::mutex mutex;
  std::set<std::thread::id> helpers;
  std::atomic<int> done = 0;
  const auto caller = [&] {
    const auto self = std::this_thread::get_id();
    for (int i = 0; i < 50; ++i) {
      parallelFor(8, 1, 3, [&](unsigned, size_t, size_t) {
        parallelFor(10, 1, 2, [&](unsigned, size_t, size_t) { ++done; });
        if (std::this_thread::get_id() == self) return;
        const std::lock_guard lock(mutex);
        helpers.insert(std::this_thread::get_id());
      });
    }
  };
  {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 3; ++i) callers.emplace_back(caller);
  }
  CHECK(done == 3 * 50 * 8 * 10);
  // At most one for each core, or as many as one loop asks for; other tests may have asked for more.
  CHECK(helpers.size() <= std::max(4u, threadCount(0)));
}

TEST_CASE("no call begins after one has thrown, and later loops run all") {
  std::atomic<int> calls = 0;
  CHECK_THROWS_WITH(parallelFor(1000, 1, 1,
                                [&](unsigned, size_t first, size_t) {
                                  ++calls;
                                  if (first == 7) throw std::runtime_error("thrown");
                                }),
                    "thrown");
  CHECK(calls == 8);
  parallelFor(1000, 1, 3, [&](unsigned, size_t, size_t) { ++calls; });
  CHECK(calls == 1008);
}

TEST_CASE("a process that forked starts threads of its own") {
  std::atomic<int> calls = 0;
  const auto loop = [&] { parallelFor(100, 1, 3, [&](unsigned, size_t, size_t) { ++calls; }); };
  loop();
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    loop();
    radar::endLoopThreads();
    loop();
    _exit(calls == 300 ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  loop();
  CHECK(calls == 200);
}
