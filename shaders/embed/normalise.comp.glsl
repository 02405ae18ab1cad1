// Describes meshes that a host deforms without bounds, by the bounds that bound.comp has found, one invocation per mesh: their
// boxes, and the origin and unit with which their vertices are normalised (engine/scene/scene.h).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/float_order.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotUnbounded) readonly restrict buffer Unbounded { uint unbounded[]; };
layout(scalar, binding = kSlotExtents) readonly restrict buffer Extents { Extent extents[]; };

layout(push_constant) uniform PushConstants { NormalisePush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Extent extent = extents[i];
  MeshRecord mesh = meshes[unbounded[i]];
  float largest = 0.0;
  for (uint k = 0; k < 3; ++k) {
    const float lo = floatOf(extent.lo[k]), hi = floatOf(~extent.hi[k]);
    precise float middle = 0.5 * lo + 0.5 * hi;
    const float halfExtent = 0.5 * hi - 0.5 * lo;
    // By Sterbenz's lemma all vertices - origin are exact.
    mesh.origin[k] = abs(middle) >= 2.5 * halfExtent ? middle : 0.0;
    precise float localLo = lo - mesh.origin[k], localHi = hi - mesh.origin[k];
    largest = max(largest, max(abs(localLo), abs(localHi)));
    // Room for coordinates that flush to 0.
    mesh.lo[k] = localLo - 2.4e-38;
    mesh.hi[k] = localHi + 2.4e-38;
  }
  const uint exponent = max(floatBitsToUint(largest) >> 23, 1u);
  mesh.unit = largest > 0.0 ? uintBitsToFloat(exponent << 23) : 1.0;
  mesh.perUnit = largest > 0.0 ? uintBitsToFloat((254u - exponent) << 23) : 1.0;
  meshes[unbounded[i]] = mesh;
}
