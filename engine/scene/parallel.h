// Parallel loops.
#pragma once

#include <cstddef>
#include <functional>

namespace radar {

/// Calls work(worker, first, last) for consecutive chunks [first, last) of 0 ... count - 1, of at most `chunk` numbers
/// each, on up to `threads` threads (0: one per core), including the caller's. `worker` is below the number of threads;
/// no two calls with the same one run at a time. If threads cannot be started, fewer do the work. Rethrows an exception
/// of a call once all threads have ended.
void parallelFor(size_t count, size_t chunk, unsigned threads,
                 const std::function<void(unsigned worker, size_t first, size_t last)>& work);

/// `threads`, or the number of cores if it is 0.
unsigned threadCount(unsigned threads);

}  // namespace radar
