// Bounds the centres of the parts of the tree over objects, one invocation per part.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/float_order.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotObjectNodes) readonly restrict buffer Nodes { ObjectNode nodes[]; };
layout(scalar, binding = kSlotParts) readonly restrict buffer Parts { uint parts[]; };
layout(scalar, binding = kSlotExtents) restrict buffer Extents { Extent extents[]; };

layout(push_constant) uniform PushConstants { PartsPush push; };

shared uint least[3], leastNegated[3];

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x, local = gl_LocalInvocationID.x;
  if (local < 3) least[local] = leastNegated[local] = kNobody;
  barrier();
  const uvec3 at = inOrder(floatBitsToUint(nodes[parts[min(i, push.count - 1)]].centre));
  for (uint k = 0; k < 3; ++k) {
    atomicMin(least[k], at[k]);
    atomicMin(leastNegated[k], ~at[k]);
  }
  barrier();
  if (local < 3) {
    atomicMin(extents[0].lo[local], least[local]);
    atomicMin(extents[0].hi[local], leastNegated[local]);
  }
}
