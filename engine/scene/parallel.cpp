#include "scene/parallel.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace radar {

unsigned threadCount(unsigned threads) {
  return threads != 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

void parallelFor(size_t count, size_t chunk, unsigned threads,
                 const std::function<void(unsigned worker, size_t first, size_t last)>& work) {
  const size_t chunks = (count + chunk - 1) / chunk;
  std::atomic<size_t> next = 0;
  const auto run = [&](unsigned worker) {
    for (size_t i = next++; i < chunks; i = next++) work(worker, i * chunk, std::min(count, (i + 1) * chunk));
  };
  std::vector<std::future<void>> others;
  const size_t workers = std::min<size_t>(threadCount(threads), chunks);
  try {
    if (workers > 1) others.reserve(workers - 1);
    for (unsigned worker = 1; worker < workers; ++worker) {
      others.push_back(std::async(std::launch::async, run, worker));
    }
  } catch (const std::bad_alloc&) {  // those that run do all the work
  } catch (const std::system_error&) {
  }
  if (chunks > 0) run(0);
  for (std::future<void>& other : others) other.get();
}

}  // namespace radar
