// The host's memory and threads, as this program's operator new and pthread_create give them: a test makes the n-th
// request fail. Only the engine's requests count: those of the test's own thread while an EngineWork lives, and of
// threads started then, but not those within a Vulkan function.
#pragma once

#include <cstdint>

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

}  // namespace radar::test
