// Random shapes of a kind, for the families: about 2 wide, around the origin.
#pragma once

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

MeshData convexShape(Random& random);
MeshData nonConvexShape(Random& random);
MeshData openShape(Random& random);
/// Self-intersecting, or every triangle twice.
MeshData crossingShape(Random& random);
/// Triangles without any order.
MeshData soupShape(Random& random);
/// One of the kinds above.
MeshData anyShape(Random& random);

}  // namespace radar::tools
