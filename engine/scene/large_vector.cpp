#include "scene/large_vector.h"

#include <sys/mman.h>

#include <cstdint>

namespace radar {

void adviseHugePages([[maybe_unused]] void* memory, [[maybe_unused]] size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr size_t kPage = 4096, kWorth = size_t{4} << 20;
  if (bytes < kWorth) return;
  const size_t before = (kPage - reinterpret_cast<uintptr_t>(memory) % kPage) % kPage;
  madvise(static_cast<char*>(memory) + before, (bytes - before) / kPage * kPage, MADV_HUGEPAGE);
#endif
}

}  // namespace radar
