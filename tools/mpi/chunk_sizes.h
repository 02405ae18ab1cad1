// How many queries a rank gets at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "answer/chunk_size.h"

namespace radar::tools {

/// Chunks of about a tenth of a second by the rank's last chunk, so that costly queries that stand together are shared;
/// and smaller towards the end, so that all ranks finish at about the same time.
class ChunkSizes {
 public:
  explicit ChunkSizes(size_t ranks);
  /// The size of a rank's next chunk of `remaining` queries, at least 1.
  uint64_t next(size_t rank, uint64_t remaining) const;
  /// A rank answered `count` queries in `seconds`.
  void answered(size_t rank, uint64_t count, double seconds);

 private:
  std::vector<ChunkSize> sizes_;
};

}  // namespace radar::tools
