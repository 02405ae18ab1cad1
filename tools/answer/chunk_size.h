// How many queries to answer together.
#pragma once

#include <algorithm>
#include <cstdint>

namespace radar::tools {

/// As many as take about `seconds`, by the last ones: a query may take anything from a microsecond to a second, so the
/// first are few, and numbers grow by no more than a factor of eight. Answers do not depend on it.
struct ChunkSize {
  double seconds;
  uint64_t next, least, most;

  void answered(uint64_t count, double inSeconds) {
    const double wanted = static_cast<double>(count) * seconds / std::max(inSeconds, 1e-9);
    const auto limit = static_cast<double>(std::clamp(8 * count, least, most));
    next = static_cast<uint64_t>(std::clamp(wanted, static_cast<double>(least), limit));
  }
};

}  // namespace radar::tools
