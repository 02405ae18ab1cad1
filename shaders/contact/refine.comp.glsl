// Solves the refined pairs that certify.comp leaves in double precision, which may lower the upper bound of first contact.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "refined_pair.glsl"
#include "shared/triangle_pair_bounds.glsl"

// Leaves it to prove.comp and block.comp whether a pair blocks, or to separate.comp when it meets.
void leaveOpen(uint pair) {
  const uint place = atomicAdd(counts.openPairs, 1), group = place / kContactGroup;
  refinedPairs[place].open = pair;
  if (place % kContactGroup != 0) return;
  atomicMax(counts.openGroups[0], min(group + 1, kMostWorkgroups));
  atomicMax(counts.openGroups[1], group / kMostWorkgroups + 1);
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.leftPairs) return;
  const uint i = refinedPairs[place].left;
  const uint search = refinedPairs[i].search;
  const double direction[3] = sweeps[search].direction;
  dvec3 a[3], b[3];
  placedCorners(sweeps[search].pose, refinedPairs[i].slotA, a);
  placedCorners(objects[refinedPairs[i].object].pose, refinedPairs[i].slotB, b);
  const Impact m = impactOf(a, b, dvec3(direction[0], direction[1], direction[2]));
  const Sweep sweep = sweeps[search];
  const bool ignoresLeaving = sweep.ignoreLeaving != 0;
  const double earliest = firstOf(m), last = lastOf(m);
  const bool sharp = m.ahead && m.at - m.error > 0.0LF && min(m.others, m.unknown) > last;
  // A contact that ends before the start counts as never.
  const double low =
      m.isOver ? kNever : max(min(earliest, m.unknown), 0.0LF) * sweep.directionLength * (1.0LF - kRounded);
  refinedPairs[i].low = low;
  refinedPairs[i].at = m.at;
  refinedPairs[i].error = m.error;
  refinedPairs[i].flags = (m.ahead ? kPairMeets : 0) | (m.ahead && last < 0.0LF ? kPairPierces : 0) |
                        (sharp ? kPairSharp : 0) | (m.isOver ? kPairParted : 0) | m.corners << kPairCorners | (m.feature & 0xffu);
  // A pair that may not meet may yet be pressed together, and then counts from the start (block.comp).
  float first = refinedPairs[i].first;
  if (m.ahead || !ignoresLeaving) first = max(first, scaledDown(low, sweep));
  refinedPairs[i].first = first;
  if (m.ahead && !ignoresLeaving) lowerHi(search, sweep, last);
  if ((ignoresLeaving || !sharp) && first <= uintBitsToFloat(states[search].hi)) leaveOpen(i);
}
