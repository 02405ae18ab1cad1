// Whether memory stays flat while epochs come and go.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace radar::soak {

/// What is left once everything of an epoch is destroyed.
struct Left {
  size_t residentBytes = 0;
  int64_t vulkanObjects = 0, hostBlocks = 0;  ///< of the engine
};
Left leftNow();

/// What has leaked, in words; empty if nothing has. Vulkan objects must all be gone after each epoch. Host blocks must
/// be as many at the end as a quarter before it. Of the resident set, the median of the last quarter of epochs is at
/// most 5 % and 8 MiB above that of the second quarter: the first warms up. With fewer than kEpochsToJudge, it is not
/// judged.
inline constexpr size_t kEpochsToJudge = 16;
std::string leakIn(const std::vector<Left>& epochs);

/// Medians of the resident set, of the second and of the last quarter.
struct Medians {
  size_t second = 0, last = 0;
};
Medians mediansOf(const std::vector<Left>& epochs);

}  // namespace radar::soak
