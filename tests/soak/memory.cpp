#include "soak/memory.h"

#include <malloc.h>

#include <algorithm>

#include "faults/host_memory.h"
#include "support/resident.h"
#include "support/watched_vulkan.h"

namespace radar::soak {

namespace {

size_t medianOf(std::vector<Left>::const_iterator first, std::vector<Left>::const_iterator last) {
  std::vector<size_t> sizes;
  for (; first != last; ++first) sizes.push_back(first->residentBytes);
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + static_cast<ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

Left leftNow() {
  malloc_trim(0);
  return {test::residentBytes(), test::liveVulkanObjects(), test::host_memory::live()};
}

Medians mediansOf(const std::vector<Left>& epochs) {
  const auto quarter = static_cast<ptrdiff_t>(epochs.size() / 4);
  return {medianOf(epochs.begin() + quarter, epochs.begin() + 2 * quarter),
          medianOf(epochs.end() - quarter, epochs.end())};
}

std::string leakIn(const std::vector<Left>& epochs) {
  if (epochs.empty()) return "";
  for (const Left& left : epochs) {
    if (left.vulkanObjects != 0) return std::to_string(left.vulkanObjects) + " Vulkan objects left after an epoch";
  }
  const int64_t before = epochs[epochs.size() - 1 - epochs.size() / 4].hostBlocks;
  if (epochs.back().hostBlocks > before) {
    return std::to_string(epochs.back().hostBlocks - before) + " blocks of host memory left in the last quarter";
  }
  if (epochs.size() < kEpochsToJudge) return "";
  const Medians medians = mediansOf(epochs);
  if (medians.last <= medians.second + medians.second / 20 + (8u << 20)) return "";
  return "the resident set has grown from " + std::to_string(medians.second >> 20) + " to " +
         std::to_string(medians.last >> 20) + " MiB";
}

}  // namespace radar::soak
