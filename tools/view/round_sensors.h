// Sensors that a clearance makes balls and capsules, as meshes that can be drawn.
#pragma once

#include <span>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// Of each query whose sensor is a point or a segment with a radius (radar/shapes.h) or a clearance: a ball or capsule
/// of facets, in a pose that does not scale. Others stay as they are.
struct RoundSensors {
  explicit RoundSensors(const Workload& workload, std::span<const QuerySpec> queries);

  /// Beside the workload's, whose numbers come first. Each has the radius of the mesh that it stands for, which is 0 if
  /// the query's clearance rounds that.
  std::vector<MeshData> meshes;
  std::vector<Instance> sensors;  ///< of the queries
};

}  // namespace radar::tools
