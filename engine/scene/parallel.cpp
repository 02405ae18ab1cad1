#include "scene/parallel.h"

#ifndef _WIN32
#include <unistd.h>
#endif

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "math/float_environment.h"

namespace radar {

namespace {

int processId() {
#ifdef _WIN32
  return 0;  // processes do not fork
#else
  return getpid();
#endif
}

struct Loop {
  const void* work;
  ChunkCall call;
  size_t count, chunk, chunks;
  unsigned threads;  ///< that may take part
  std::atomic<size_t> next = 0;
  // What follows belongs to the Crew.
  unsigned joined = 1, atWork = 0;  ///< the caller has joined
  std::exception_ptr thrown = nullptr;
  std::condition_variable ended = {};
  Loop* following = nullptr;

  bool isOpen() const { return joined < threads && next < chunks; }
  void run(unsigned worker) {
    for (size_t i = next++; i < chunks; i = next++) call(work, worker, i * chunk, std::min(count, (i + 1) * chunk));
  }
};

// The threads of one process, and the loops that run. Who begins a loop works in it until nothing is left, so that each
// loop ends whether or not a thread has time for it.
class Crew {
 public:
  ~Crew() {
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void run(Loop& loop) {
    std::unique_lock lock(mutex_);
    loop.following = loops_;
    loops_ = &loop;
    const size_t wanted = loop.threads - 1;
    grow(wanted);
    const bool wantsAll = wanted >= idle_;
    lock.unlock();
    if (wantsAll) wake_.notify_all();
    for (size_t i = 0; i < wanted && !wantsAll; ++i) wake_.notify_one();
    take(loop, 0, lock);
    Loop** at = &loops_;
    while (*at != &loop) at = &(*at)->following;
    *at = loop.following;
    loop.ended.wait(lock, [&] { return loop.atWork == 0; });
    if (loop.thrown) std::rethrow_exception(loop.thrown);
  }

  const int process = processId();

 private:
  // Until `wanted` threads are idle, but no more in all than one loop asks for or there are cores.
  void grow(size_t wanted) {
    const size_t most = std::max<size_t>(wanted, threadCount(0) - 1);
    try {
      threads_.reserve(most);
      for (size_t idle = idle_; idle < wanted && threads_.size() < most; ++idle) {
        threads_.emplace_back([this] { serve(); });
        ++idle_;  // until it takes part in something
      }
    } catch (const std::bad_alloc&) {  // those that run do all the work
    } catch (const std::system_error&) {
    }
  }

  // Runs chunks, without the lock.
  void take(Loop& loop, unsigned worker, std::unique_lock<std::mutex>& lock) {
    std::exception_ptr thrown;
    try {
      loop.run(worker);
    } catch (...) {
      thrown = std::current_exception();
      loop.next = loop.chunks;
    }
    lock.lock();
    if (thrown && !loop.thrown) loop.thrown = thrown;
  }

  Loop* openLoop() const {
    Loop* loop = loops_;
    while (loop != nullptr && !loop->isOpen()) loop = loop->following;
    return loop;
  }

  void serve() {
    const FloatEnvironment floats;  // whoever started this may have had another
    std::unique_lock lock(mutex_);
    for (;;) {
      Loop* const loop = openLoop();
      if (loop == nullptr) {
        if (ends_) return;
        wake_.wait(lock);
        continue;
      }
      --idle_;
      ++loop->atWork;
      const unsigned worker = loop->joined++;
      lock.unlock();
      take(*loop, worker, lock);
      ++idle_;
      if (--loop->atWork == 0) loop->ended.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  Loop* loops_ = nullptr;
  size_t idle_ = 0;
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

std::atomic<Crew*> current = nullptr;

// A process that forked has none of the threads, and leaves what the other one knows of them alone. Null: no memory.
Crew* crew() {
  Crew* found = current;
  while (found == nullptr || found->process != processId()) {
    std::unique_ptr<Crew> made(new (std::nothrow) Crew);
    if (!made || current.compare_exchange_strong(found, made.get())) return made.release();
  }
  return found;
}

// Before the library is unloaded.
const struct AtExit {
  ~AtExit() { endLoopThreads(); }
} atExit;

}  // namespace

void endLoopThreads() {
  Crew* const found = current.exchange(nullptr);
  if (found != nullptr && found->process == processId()) delete found;
}

unsigned threadCount(unsigned threads) {
  // The system reads a file to tell, which takes longer than a query.
  static const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return threads != 0 ? threads : cores;
}

void parallelFor(size_t count, size_t chunk, unsigned threads, const void* work, ChunkCall call) {
  const size_t chunks = (count + chunk - 1) / chunk;
  const auto most = static_cast<unsigned>(std::min<size_t>(threadCount(threads), chunks));
  Loop loop{work, call, count, chunk, chunks, most};
  Crew* const others = most > 1 ? crew() : nullptr;
  if (others != nullptr) {
    others->run(loop);
  } else {
    loop.run(0);
  }
}

}  // namespace radar
