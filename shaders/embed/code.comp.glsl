// Gives the parts of the tree over objects numbers by which to sort them in space, one invocation per part: the cell around a
// part's centre, which is halved 32 times, each time across its longest side. In a flat world, Morton codes would halve its
// height as often as its length, and searches would test 1.6 times as many nodes.
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
layout(scalar, binding = kSlotExtents) readonly restrict buffer Extents { Extent extents[]; };
layout(scalar, binding = kSlotSorted) writeonly restrict buffer Sorted { Part sorted[]; };

layout(push_constant) uniform PushConstants { PartsPush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const vec3 centre = nodes[parts[i]].centre;
  vec3 low, side;
  for (uint k = 0; k < 3; ++k) {
    low[k] = floatOf(extents[0].lo[k]);
    side[k] = floatOf(~extents[0].hi[k]) - low[k];
  }
  uint code = 0;
  for (uint bit = 0; bit < 32; ++bit) {
    const uint longest = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    side[longest] *= 0.5;
    const float middle = low[longest] + side[longest];
    const bool isUpper = centre[longest] >= middle;
    if (isUpper) low[longest] = middle;
    code = code << 1 | uint(isUpper);
  }
  sorted[i] = Part(code, parts[i]);
}
