// Solves the refined pairs that certify.comp leaves in double precision, which may lower the upper bound of first contact.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "shared/triangle_pair_bounds.glsl"
#include "shared/scene.glsl"
#include "placed_corners.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;
// Whether any query ignores what does not block. Constant, because some devices execute what they skip.
layout(constant_id = 0) const bool kIgnoresLeaving = false;

layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
layout(scalar, binding = kSlotSweeps) readonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };

#include "certificate.glsl"
#include "lower_hi.glsl"
#include "slack.glsl"

// Leaves it to block.comp whether a pair blocks.
void leaveOpen(uint pair) {
  const uint place = atomicAdd(counts.openPairs, 1), group = place / kContactGroup;
  refinedPairs[place].open = pair;
  if (place % kContactGroup != 0) return;
  atomicMax(counts.blockGroups[0], min(group + 1, kMostWorkgroups));
  atomicMax(counts.blockGroups[1], group / kMostWorkgroups + 1);
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.leftPairs) return;
  const uint i = refinedPairs[place].left;
  const RefinedPair c = refinedPairs[i];
  const Sweep sweep = sweeps[c.sensor];
  dvec3 a[3], b[3];
  placedCorners(sweep.pose, c.slotA, a);
  placedCorners(objects[c.object].pose, c.slotB, b);
  const dvec3 direction = dvec3(sweep.direction[0], sweep.direction[1], sweep.direction[2]);
  const Impact m = impactOf(a, b, direction);
  const bool ignoresLeaving = kIgnoresLeaving && sweep.ignoreLeaving != 0;
  bool blocks = !ignoresLeaving;
  if (ignoresLeaving && m.ahead && m.at > m.error && wouldLowerHi(c.sensor, sweep, m.at + m.error)) {
    const Bounded slack = slackOf(sweep, c);
    blocks = certainlyBlocks(m.feature, a, b, direction, slack.value + slack.error);
  }
  const bool sharp = m.ahead && m.at - m.error > 0.0LF && min(m.others, m.unknown) > m.by;
  // A contact that ends before the start counts as never.
  const bool parted = m.latest < 0.0LF;
  const double low =
      parted ? kNever : max(min(m.earliest, m.unknown), 0.0LF) * sweep.directionLength * (1.0LF - kRounded);
  refinedPairs[i].low = low;
  refinedPairs[i].at = m.at;
  refinedPairs[i].error = m.error;
  refinedPairs[i].flags = (m.ahead ? kPairMeets : 0) | (m.ahead && m.by < 0.0LF ? kPairPierces : 0) |
                        (sharp ? kPairSharp : 0) | (parted ? kPairParted : 0) | (m.feature & 0xffu);
  // A pair that may not meet may yet be pressed together, and then counts from the start (block.comp).
  const float first = m.ahead || !ignoresLeaving ? max(c.first, scaledDown(low, sweep)) : c.first;
  refinedPairs[i].first = first;
  if (m.ahead && blocks) lowerHi(c.sensor, sweep, m.at + m.error);
  if (!blocks && first <= uintBitsToFloat(states[c.sensor].hi)) leaveOpen(i);
}
