// Solves the refined pairs in double precision, which may lower the upper bound of first contact.
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

layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) readonly restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
layout(scalar, binding = kSlotSweeps) readonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };

#include "lower_hi.glsl"

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= counts.refinedPairs) return;
  const RefinedPair c = refinedPairs[i];
  const Sweep sweep = sweeps[c.sensor];
  dvec3 a[3], b[3];
  placedCorners(sweep.pose, c.slotA, a);
  placedCorners(objects[c.object].pose, c.slotB, b);
  const Impact m = impactOf(a, b, dvec3(sweep.direction[0], sweep.direction[1], sweep.direction[2]));
  const bool sharp = m.ahead && m.at - m.error > 0.0LF && min(m.others, m.unknown) > m.by;
  // A contact that ends before the start counts as never, unless the pair may be pressed together (block.comp).
  const bool parted = m.latest < 0.0LF;
  const double begins = max(min(m.earliest, m.unknown), 0.0LF) * sweep.directionLength * (1.0LF - kRounded);
  const double low = !parted ? begins : sweep.ignoreLeaving != 0 ? 0.0LF : kNever;
  refinedPairs[i].low = low;
  refinedPairs[i].at = m.at;
  refinedPairs[i].error = m.error;
  refinedPairs[i].flags = (m.ahead ? kPairMeets : 0) | (m.ahead && m.by < 0.0LF ? kPairPierces : 0) |
                        (sharp ? kPairSharp : 0) | (parted ? kPairParted : 0) | (m.feature & 0xffu);
  const double scale = double(sweep.scale);
  refinedPairs[i].first = max(c.first, float(min(low * scale, 1e38LF) * (1.0LF - kRoundedFloat)));
  // Whether a pair counts that may not block is decided next.
  if (m.ahead && sweep.ignoreLeaving == 0) lowerHi(c.sensor, sweep, m.at + m.error);
}
