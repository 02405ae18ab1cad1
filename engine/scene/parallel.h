// Loops on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace radar {

/// Calls work(worker, first, last) for consecutive chunks [first, last) of 0 ... count - 1, each of `chunk` numbers at
/// most, on up to `threads` threads (0: one for each core), the caller's among them; a thread takes the next chunk when
/// it is done with its last. `worker` is below the number of threads, and no two calls with one run at a time. What a
/// call throws is thrown here, once all threads have ended.
void parallelFor(size_t count, size_t chunk, unsigned threads,
                 const std::function<void(unsigned worker, size_t first, size_t last)>& work);

/// `threads`, or the number of cores where that is 0.
unsigned threadCount(unsigned threads);

}  // namespace radar
