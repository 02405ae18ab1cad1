// Copies the candidates that may still be first after the search to the refined pairs.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/double_bits.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) readonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotCandidatePairs) readonly restrict buffer Candidates { CandidatePair candidates[]; };
layout(scalar, binding = kSlotRefinedPairs) writeonly restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };

layout(push_constant) uniform PushConstants { FilterPush push; };

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= min(counts.candidates, push.candidateCapacity)) return;
  const CandidatePair c = candidates[i];
  if (c.low > uintBitsToFloat(states[c.search].hi) || c.object > states[c.search].least) return;
  refinedPairs[atomicAdd(counts.refinedPairs, 1)] = RefinedPair(doubleBits(floatBitsToUint(c.low)), uvec2(0), uvec2(0), c.search,
                                                          c.object, c.slotA, c.slotB, 0, kNobody, c.low, 0, 0, c.feature);
}
