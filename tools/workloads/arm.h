// A robot's arm in a cell: six links about six axes, among parts on shelves.
#pragma once

#include "radar/chain.h"
#include "workloads/workload.h"

namespace radar::tools {

struct ArmCell {
  Workload workload;  ///< its meshes, first those of the links; one scene, the cell
  Chain chain;        ///< of these meshes; links that are no neighbours are tested with each other
  /// Where motions begin, 6 angles, and end, 6 more: up to `turn` radians from there at each joint.
  std::vector<std::array<double, 12>> motions;
};

struct ArmOptions {
  uint32_t motions = 1'000;
  double turn = 1;
  uint32_t detail = 50;  ///< triangles grow with its square: 1,000 of each link and 99,200 of the cell's parts at 50
  uint64_t seed = 1;
};
ArmCell makeArmCell(const ArmOptions& options);

}  // namespace radar::tools
