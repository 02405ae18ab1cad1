// Whose requests for memory and threads count in tests of failures (faults/host_memory.h).
#pragma once

namespace radar::test {

/// Whether those of this thread do.
inline thread_local bool countsRequests = false;

template <bool kCounts>
class CountedWork {
 public:
  CountedWork() { countsRequests = kCounts; }
  ~CountedWork() { countsRequests = before_; }
  CountedWork(const CountedWork&) = delete;
  CountedWork& operator=(const CountedWork&) = delete;

 private:
  bool before_ = countsRequests;
};
/// Lets the requests of this thread count, and not count.
using EngineWork = CountedWork<true>;
using OthersWork = CountedWork<false>;

}  // namespace radar::test
