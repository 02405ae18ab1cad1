// Links those contenders of each sensor that may still be first into a list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) readonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotHeads) restrict buffer Heads { uint heads[]; };
layout(scalar, binding = kSlotCounts) readonly restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotContenders) restrict buffer Contenders { Contender contenders[]; };

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= counts.contenders || contenders[i].first > uintBitsToFloat(states[contenders[i].sensor].hi)) return;
  contenders[i].next = atomicExchange(heads[contenders[i].sensor], i);
}
