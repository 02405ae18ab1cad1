// Pairs of clusters that can meet: a workgroup takes a few clusters of the sensor, neighbours in their tree, and a run of the
// scene's, of which only what can meet the box around those few is held against each. All are counted; those beyond the capacity are not kept, and the host makes room and asks again.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

const uint kLanes = 64;
layout(local_size_x = kLanes) in;

layout(scalar, binding = kBindTargets) readonly restrict buffer Targets { Target targets[]; };
layout(scalar, binding = kBindBoxes) readonly restrict buffer Boxes { RefBox boxes[]; };
layout(scalar, binding = kBindPairItems) readonly restrict buffer PairItems { PairItem items[]; };
layout(scalar, binding = kBindClusterPairs) writeonly restrict buffer ClusterPairs { ClusterPair pairs[]; };
layout(scalar, binding = kBindStates) restrict buffer States { State states[]; };

layout(push_constant) uniform Push { uint count; uint groupsX; } push;

// Clusters of the scene looked through at a time.
const uint kTested = 1024;

shared vec3 lowest[kPairItemA], highest[kPairItemA];
shared uint nearCount;
shared uint near[kTested];

// Least gap along the motion between boxes a, of the sensor, and b; -1: they cannot meet within `farthest`.
float gapBetween(vec3 loA, vec3 hiA, vec3 loB, vec3 hiB, float farthest) {
  const float gap = max(loB.z - hiA.z, 0.0);
  const bool across = all(lessThanEqual(loA.xy, hiB.xy)) && all(lessThanEqual(loB.xy, hiA.xy));
  return across && hiB.z >= loA.z && gap <= farthest ? gap : -1.0;
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const PairItem item = items[group];
  const uint lane = gl_LocalInvocationID.x;
  const uint a = item.firstA + lane % kPairItemA;
  const vec3 loA = boxes[min(a, item.endA - 1)].lo, hiA = boxes[min(a, item.endA - 1)].hi;
  if (lane < kPairItemA) {
    lowest[lane] = loA;
    highest[lane] = hiA;
  }
  if (lane == 0) nearCount = 0;
  barrier();
  vec3 lo = lowest[0], hi = highest[0];
  for (uint i = 1; i < kPairItemA; ++i) {
    lo = min(lo, lowest[i]);
    hi = max(hi, highest[i]);
  }
  const float farthest = states[item.target].hi;
  const uint first = targets[item.target].firstPair, capacity = targets[item.target].pairCapacity;
  for (uint start = item.firstB; start < item.endB; start += kTested) {
    const uint end = min(start + kTested, item.endB);
    for (uint b = start + lane; b < end; b += kLanes) {
      if (gapBetween(lo, hi, boxes[b].lo, boxes[b].hi, farthest) >= 0.0) near[atomicAdd(nearCount, 1)] = b;
    }
    barrier();
    const uint count = nearCount;
    for (uint i = lane / kPairItemA; i < count; i += kLanes / kPairItemA) {
      const uint b = near[i];
      const float gap = gapBetween(loA, hiA, boxes[b].lo, boxes[b].hi, farthest);
      if (a >= item.endA || gap < 0.0) continue;
      const uint at = atomicAdd(states[item.target].pairCount, 1);
      if (at < capacity) pairs[first + at] = ClusterPair(gap, a, b);
    }
    barrier();
    if (lane == 0) nearCount = 0;
    barrier();
  }
}
