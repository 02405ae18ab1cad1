#include "mpi/own_thread.h"

#include <new>

#include "support/catch.h"

using radar::tools::Answered;
using radar::tools::OwnThread;

namespace {

Answered takeOne(OwnThread& thread) {
  for (;;) {
    if (std::optional<Answered> answered = thread.take()) return *answered;
  }
}

}  // namespace

TEST_CASE("rank 0's own thread answers in order, and ends whenever the run does") {
  // One in some 100,000 would sleep for ever: it was told to end just before it fell asleep.
  for (uint64_t run = 0; run < 10'000; ++run) {
    OwnThread thread([](uint64_t first, uint64_t count) { return Answered{first, count}; });
    thread.give(run, 1);
    if (run % 2 == 0) continue;
    thread.give(run + 1, 2);
    REQUIRE(takeOne(thread).first == run);
    REQUIRE(takeOne(thread).count == 2);
  }
}

TEST_CASE("a lack of memory on rank 0's own thread reaches the thread that ends the run") {
  OwnThread thread([](uint64_t first, uint64_t count) -> Answered {
    if (first == 1) throw std::bad_alloc();
    return {first, count};
  });
  thread.give(0, 1);
  CHECK(takeOne(thread).first == 0);
  thread.give(1, 1);
  CHECK_THROWS_AS(takeOne(thread), std::bad_alloc);
}
