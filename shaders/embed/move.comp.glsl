// Moves objects to a host's transforms, one invocation per object: writes their poses, which are exact, and their
// placements, which carry error bounds (docs/method.md, "A host's geometry").
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotObjects) writeonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotPlacements) writeonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kSlotMoved) readonly restrict buffer MovedObjects { Moved movedObjects[]; };
layout(scalar, binding = kSlotBoundsViolation) restrict buffer BoundsViolations { BoundsViolation violation; };
#include "shared/double_bits.glsl"
#include "byte_load.glsl"
#include "transform.glsl"
#include "placement.glsl"
#include "shared/workgroup.glsl"

layout(push_constant) uniform PushConstants { MovePush push; };

// Whether the mesh's box may leave the object's bounds.
bool leavesBounds(Transform t, Moved moved, MeshRecord mesh, Position position) {
  const PlacedBox box = boxOf(t, mesh, position, moved.anchor, vec3(0.0));
  return !box.isFinite || any(greaterThan(abs(box.centre) + box.halfExtent, moved.halfExtent));
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Moved moved = movedObjects[i];
  const MeshRecord mesh = meshes[moved.mesh];
  const Transform t = transformAt(moved.firstByte, moved.format);
  const bool fits = fitsFloats(t, mesh);
  Position position;
  if (fits) position = positionOf(t, mesh.origin);
  if (!fits || leavesBounds(t, moved, mesh, position)) {
    // The recording is invalid now, but the search must still terminate.
    atomicMin(violation.object, moved.object);
    placements[moved.object].perUnit = 0.0;
    return;
  }
  objects[moved.object].pose = preciseRows(t);
  Placement placement = placementOf(mesh, t, position);
  placement.mask = moved.mask;
  placement.mesh = moved.mesh;
  placements[moved.object] = placement;
}
