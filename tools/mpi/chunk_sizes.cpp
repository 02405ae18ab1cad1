#include "mpi/chunk_sizes.h"

#include <algorithm>

namespace radar::tools {

uint64_t ChunkSizes::next(size_t rank, uint64_t remaining) const {
  constexpr double kSeconds = 0.1;
  constexpr uint64_t kFirst = 64, kLeast = 16, kMost = 65'536;
  const double rate = rates_[rank];
  const uint64_t byTime =
      rate > 0 ? static_cast<uint64_t>(std::clamp(kSeconds * rate, double{kLeast}, double{kMost})) : kFirst;
  // Each rank holds two chunks: a quarter of its share is half of it.
  const uint64_t byRest = std::max<uint64_t>(remaining / (4 * rates_.size()), kLeast);
  return std::min({byTime, byRest, remaining});
}

void ChunkSizes::answered(size_t rank, uint64_t count, double seconds) {
  rates_[rank] = static_cast<double>(count) / std::max(seconds, 1e-6);
}

}  // namespace radar::tools
