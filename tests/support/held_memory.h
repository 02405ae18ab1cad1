// How much memory a Recorder and a Sweeper hold.
#pragma once

#include <map>
#include <optional>

#include "radar/device.h"

namespace radar::test {

struct HeldMemory {
  uint64_t ofDevice = 0, ofHost = 0;  ///< bytes
  uint64_t all() const { return ofDevice + ofHost; }
};

/// A device whose memory is counted.
class CountedDevice {
 public:
  explicit CountedDevice(HostDevice host);

  /// By a Recorder for so many queries, which has just been made, and its copy of an empty scene. `lanes`: of a
  /// subgroup, as if the device had so many; 0: those that it has.
  HeldMemory heldByRecorder(uint32_t queries, uint32_t lanes = 0) const;
  /// By a Sweeper that has answered so many queries at once on the device, boxes among boxes.
  HeldMemory heldBySweeper(uint32_t queries) const;

 private:
  HeldMemory held() const;
  struct Piece {
    bool isHosts;
    VkDeviceSize bytes;
  };
  std::map<VkDeviceMemory, Piece> pieces_;
  std::optional<Device> device_;
};

}  // namespace radar::test
