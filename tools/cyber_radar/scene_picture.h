#pragma once

#include <filesystem>
#include <vector>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

/// How far a query's sensor gets.
struct Flight {
  const QuerySpec& query;
  double distance = 0;
  bool touches = false;  ///< something, at the end of that distance
};

/// Draws a scene of a cube of side kCubeSide around the origin as the method itself sees it: R of a disc that looks in
/// from a corner, shaded by its slope. What the scene adds to its base is coloured; a line from each sensor is as long
/// as its flight, with a dot where it touches something. Throws std::runtime_error if `file` cannot be written.
void writeScenePicture(const std::filesystem::path& file, Workload workload, uint32_t scene,
                       const std::vector<Flight>& flights, const Device& device);

}  // namespace radar::tools
