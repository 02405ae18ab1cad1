// Pairs of clusters that can meet: an invocation takes one cluster of the sensor and holds it against a run of the
// scene's. All are counted; those beyond the capacity are not kept, and the host makes room and asks again.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

layout(local_size_x = kPairItemA) in;

layout(scalar, binding = kBindTargets) readonly restrict buffer Targets { Target targets[]; };
layout(scalar, binding = kBindBoxes) readonly restrict buffer Boxes { RefBox boxes[]; };
layout(scalar, binding = kBindPairItems) readonly restrict buffer PairItems { PairItem items[]; };
layout(scalar, binding = kBindClusterPairs) writeonly restrict buffer ClusterPairs { ClusterPair pairs[]; };
layout(scalar, binding = kBindStates) restrict buffer States { State states[]; };

layout(push_constant) uniform Push { uint count; uint groupsX; } push;

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const PairItem item = items[group];
  const uint a = item.firstA + gl_LocalInvocationID.x;
  if (a >= item.endA) return;
  const vec3 loA = boxes[a].lo, hiA = boxes[a].hi;
  const float farthest = states[item.target].hi;
  const uint first = targets[item.target].firstPair, capacity = targets[item.target].pairCapacity;
  for (uint b = item.firstB; b < item.endB; ++b) {
    const vec3 loB = boxes[b].lo, hiB = boxes[b].hi;
    const float gap = max(loB.z - hiA.z, 0.0);
    const bool across = all(lessThanEqual(loA.xy, hiB.xy)) && all(lessThanEqual(loB.xy, hiA.xy));
    if (!across || hiB.z < loA.z || gap > farthest) continue;
    const uint at = atomicAdd(states[item.target].pairCount, 1);
    if (at < capacity) pairs[first + at] = ClusterPair(gap, a, b);
  }
}
