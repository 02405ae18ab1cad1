// Parallel loops.
#pragma once

#include <cstddef>

namespace radar {

using ChunkCall = void (*)(const void* work, unsigned worker, size_t first, size_t last);
void parallelFor(size_t count, size_t chunk, unsigned threads, const void* work, ChunkCall call);

/// Calls work(worker, first, last) for consecutive chunks [first, last) of 0 ... count - 1, of at most `chunk` numbers
/// each, on up to `threads` threads (0: one per core), including the caller's. `worker` is below the number of threads;
/// no two calls with the same one run at a time. If threads cannot be started, fewer do the work. Once a call has
/// thrown an exception no other is begun; rethrows it when all have ended.
///
/// All loops of the process share threads, which sleep between loops: waking one costs a tenth of starting it.
template <class Work>
void parallelFor(size_t count, size_t chunk, unsigned threads, const Work& work) {
  parallelFor(count, chunk, threads, static_cast<const void*>(&work),
              [](const void* of, unsigned worker, size_t first, size_t last) {
                (*static_cast<const Work*>(of))(worker, first, last);
              });
}

/// Ends those threads, while no loop runs. The next loop starts others.
void endLoopThreads();

/// `threads`, or the number of cores if it is 0, as the first call found it.
unsigned threadCount(unsigned threads);

}  // namespace radar
