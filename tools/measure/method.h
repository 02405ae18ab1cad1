// What is measured beside each other: our modes, and other libraries.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "baselines/baseline.h"
#include "measure/case.h"
#include "measure/timing.h"

namespace radar::tools {

struct Method {
  std::string family;      ///< sampled, contact, reference, "drawing all" (sampled without select), "contact on device"
                           ///< (whatever the batch), or a baseline's row
  uint32_t size = 0;       ///< pixels, rays or steps; 0: the family has one member
  uint32_t threads = 0;    ///< 0: as many as the device takes
  bool certified = false;  ///< it tells a bracket, and "none" only where that is certain
  bool apart = false;      ///< it runs in a process of its own, which may die; it knows of exclusions, but not of masks
  /// Prepares itself; the workload outlives the session.
  std::function<Session(const Workload&)> open;

  /// "sampled 64".
  std::string name() const { return size == 0 ? family : family + " " + std::to_string(size); }
};

/// Ours on each case of a section, in the order of its rows, with up to `threads` of the processor. The device outlives
/// them.
std::vector<Method> ours(const Device& device, const std::string& section, Extent extent, uint32_t threads);
/// Those of other libraries. A full run measures all sizes, on one thread and on all; others three sizes, on all where
/// the library can.
std::vector<Method> others(std::span<const BaselineRow> rows, const std::string& section, Extent extent,
                           uint32_t threads);

}  // namespace radar::tools
