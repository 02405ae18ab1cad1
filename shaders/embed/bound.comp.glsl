// Bounds the vertices of meshes that a host deforms without bounds; one invocation per kBoundRun triangles. Vertices that no
// triangle uses may be anywhere.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/float_order.glsl"
#include "shared/scene.glsl"
#include "shared/workgroup.glsl"
#include "deformed.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotExtents) restrict buffer Extents { Extent extents[]; };

layout(push_constant) uniform PushConstants { DeformedPush push; };

shared uint least[3], leastNegated[3];

void main() {
  const uint group = workgroupIndex();
  if (group >= push.groups) return;
  const Deformed own = deformed[deformedOf(group, kByBound, push.meshes)];
  const uint firstTriangle = meshes[own.mesh].firstTriangle, local = gl_LocalInvocationID.x;
  const uint first = ((group - own.firstGroup[kByBound]) * kHostGroup + local) * kBoundRun;
  if (local < 3) least[local] = leastNegated[local] = kNobody;
  barrier();
  uvec3 lo = uvec3(kNobody), hi = uvec3(kNobody);
  for (uint i = first; i < min(first + kBoundRun, own.triangles); ++i) {
    const uvec4 corners = triangleAt(firstTriangle + i);
    for (uint k = 0; k < 3; ++k) {
      const uvec3 at = inOrder(vertexBitsAt(corners[k]));
      lo = min(lo, at);
      hi = min(hi, ~at);
    }
  }
  for (uint k = 0; k < 3 && first < own.triangles; ++k) {
    atomicMin(least[k], lo[k]);
    atomicMin(leastNegated[k], hi[k]);
  }
  barrier();
  if (local < 3) {
    atomicMin(extents[own.extent].lo[local], least[local]);
    atomicMin(extents[own.extent].hi[local], leastNegated[local]);
  }
}
