// Random shapes of a kind, about 2 wide, around the origin.
#pragma once

#include <vector>

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

MeshData convexShape(Random& random);
MeshData nonConvexShape(Random& random);
MeshData openShape(Random& random);
/// Self-intersecting, or every triangle twice.
MeshData crossingShape(Random& random);
/// One of the kinds above, or triangles without any order.
MeshData anyShape(Random& random);

/// Boxes, plates, a sheet and triangles with whole and half corners.
MeshData latticeShape(Random& random);
MeshData triangleShape(Random& random);
/// 1 to 6 triangles that are, by `kind` 0 to 5, points, segments, of a doubled corner, spikes, slivers, held three
/// times.
MeshData degenerateShape(uint32_t kind, Random& random);

/// A shape whose faces, edges and corners lie at whole halves, and how far it reaches along each axis.
struct Block {
  MeshData mesh;
  Vec3 reach;
};
Block block(Random& random);

/// Two meshes, and where the second is when they interlock and the first is at the origin.
struct Interlocked {
  MeshData first, second;
  Rotation rotation;
  Vec3 offset;
};
std::vector<Interlocked> interlockedShapes();

}  // namespace radar::tools
