// A task of CAM: a cutter is let down onto a part at every point of a raster. Where does it touch?
#pragma once

#include "workloads/workload.h"

namespace radar::tools {

/// A relief of `cells` x `cells` squares, two triangles each, 100 wide and up to 12 high; a ball cutter of radius 3, a
/// sphere of 64 x 16 facets, above `columns` x `rows` points of a raster over it, which falls. One batch.
struct DropCutter {
  uint32_t cells = 87;
  uint32_t columns = 210, rows = 200;
  uint64_t seed = 29;
};
Workload makeWorkload(const DropCutter& options);

}  // namespace radar::tools
