// The host's memory and threads, as this program's operator new and pthread_create give them: a test makes the n-th
// request fail. Only the engine's requests count: those of the test's own thread while an EngineWork lives, and of
// threads started then, but not those within a Vulkan function.
#pragma once

#include <cstdint>
#include <new>
#include <string>

#include "scene/parallel.h"
#include "support/engine_work.h"

namespace radar::test {

namespace host_memory {

/// Lets request number `n` from now on fail (0: the next), an allocation by std::bad_alloc, a thread by EAGAIN;
/// `andAllLater` also those after it. Negative: none.
void failAt(int64_t n, bool andAllLater = false);
/// Requests since the last failAt().
int64_t requests();
/// Blocks that counted and have not been freed.
int64_t live();

}  // namespace host_memory

/// What became of a call of which one request was to fail.
struct Attempt {
  bool failed = false;   ///< there were enough requests for one to fail
  bool threw = false;    ///< because of it
  std::string function;  ///< of the device, that failed
};

/// Makes request number `n` of a call for host memory fail; it may throw std::bad_alloc then.
template <class Call>
Attempt attemptWithoutMemory(int64_t n, const Call& call) {
  struct Failing {
    explicit Failing(int64_t number) { host_memory::failAt(number); }
    ~Failing() { host_memory::failAt(-1); }
  };
  // Requests of threads that outlive the call do not count.
  struct OwnThreads {
    OwnThreads() { endLoopThreads(); }
    ~OwnThreads() { endLoopThreads(); }
  };
  const OwnThreads started;
  const EngineWork counting;
  const Failing failing(n);
  Attempt made;
  try {
    call();
  } catch (const std::bad_alloc&) {
    if (host_memory::requests() <= n) throw;
    made.threw = true;
  }
  made.failed = host_memory::requests() > n;
  return made;
}

}  // namespace radar::test
