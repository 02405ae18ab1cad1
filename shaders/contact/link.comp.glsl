// Links those refined pairs of each sensor that may still be first into a list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) readonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotHeads) restrict buffer Heads { uint heads[]; };
layout(scalar, binding = kSlotCounts) readonly restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= counts.refinedPairs || refinedPairs[i].first > uintBitsToFloat(states[refinedPairs[i].search].hi)) return;
  refinedPairs[i].next = atomicExchange(heads[refinedPairs[i].search], i);
}
