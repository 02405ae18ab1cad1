#include "mpi/chunk_sizes.h"

namespace radar::tools {

ChunkSizes::ChunkSizes(size_t ranks) : sizes_(ranks, {.seconds = 0.1, .next = 64, .least = 16, .most = 65'536}) {}

uint64_t ChunkSizes::next(size_t rank, uint64_t remaining) const {
  const ChunkSize& size = sizes_[rank];
  // Each rank holds two chunks: a quarter of its share is half of it.
  const uint64_t byRest = std::max<uint64_t>(remaining / (4 * sizes_.size()), size.least);
  return std::min({size.next, byRest, remaining});
}

void ChunkSizes::answered(size_t rank, uint64_t count, double seconds) {
  sizes_[rank].answered(count, seconds);
}

}  // namespace radar::tools
