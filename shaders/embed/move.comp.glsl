// Moves objects to a host's transforms, one invocation per object: writes their poses, which are exact, and their
// placements, which carry error bounds; and fits the leaves of those without bounds (docs/method.md, "A host's geometry").
// Objects that stand, but whose meshes a host deforms without bounds, get placements and leaves, too.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotObjects) restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotPlacements) writeonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kSlotMoved) readonly restrict buffer MovedObjects { Moved movedObjects[]; };
layout(scalar, binding = kSlotObjectNodes) writeonly restrict buffer Nodes { ObjectNode nodes[]; };
layout(scalar, binding = kSlotBoundsViolation) restrict buffer BoundsViolations { BoundsViolation violation; };
#include "byte_load.glsl"
#include "shared/transform.glsl"
#include "load_transform.glsl"
#include "shared/placement.glsl"
#include "shared/workgroup.glsl"

layout(scalar, push_constant) uniform PushConstants { MovePush push; };

// The placed mesh's box about the middle of its bounds or, without bounds, the anchor of the tree over objects.
PlacedBox boxOf(Transform t, Moved moved, MeshRecord mesh, Position position) {
  const bool isBounded = moved.leaf == kNobody;
  return boxOf(t, mesh, position, isBounded ? moved.anchor : push.anchor, isBounded ? vec3(0.0) : push.anchorLow);
}

// The leaf's box has room for the rounding of its ends, too, from which fit.comp computes those above.
void fitLeaf(uint leaf, PlacedBox box, Position position) {
  const vec3 halfExtent = box.halfExtent + 5.7e-14 * (abs(position.high) + abs(push.anchor)) + box.flushed;  // 2^-44
  nodes[leaf].centre = box.centre;
  nodes[leaf].halfExtent = 1.000001 * halfExtent + 3e-7 * abs(box.centre);
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Moved moved = movedObjects[i];
  const MeshRecord mesh = meshes[moved.mesh];
  const bool isStanding = moved.firstByte == kNobody;
  Transform t;
  if (isStanding) {
    t = transformOf(objects[moved.object].pose);
  } else {
    t = transformAt(moved.firstByte, moved.format);
  }
  const bool fits = fitsFloats(t, mesh);
  Position position;
  PlacedBox box;
  if (fits) {
    position = positionOf(t, mesh.origin);
    box = boxOf(t, moved, mesh, position);
  }
  if (!fits || !box.isFinite || any(greaterThan(abs(box.centre) + box.halfExtent, moved.halfExtent))) {
    // The recording is invalid now, but the search must still terminate.
    atomicMin(violation.object, moved.object);
    placements[moved.object].perUnit = 0.0;
    return;
  }
  if (!isStanding) objects[moved.object].pose = preciseRows(t);
  Placement placement = placementOf(mesh, t, position);
  placement.mask = moved.mask;
  placement.mesh = moved.mesh;
  placements[moved.object] = placement;
  if (moved.leaf != kNobody) fitLeaf(moved.leaf, box, position);
}
