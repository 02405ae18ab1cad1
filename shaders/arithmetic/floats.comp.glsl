// Computes with the float arithmetic that the search's error bounds assume; the CPU compares the results with its own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/two_floats.glsl"
#include "shared/transform.glsl"
#include "embed/box_around.glsl"

layout(local_size_x = kTrialGroup) in;
layout(constant_id = 0) const uint kFalsified = kNoOperation;

layout(scalar, binding = kSlotFloatTrials) readonly restrict buffer Trials { FloatTrial trials[]; };
layout(scalar, binding = kSlotFloatOutcomes) writeonly restrict buffer Outcomes { FloatOutcome outcomes[]; };

// The result, falsified if the check asks for that.
float reported(uint operation, float result) {
  return kFalsified == operation ? uintBitsToFloat(floatBitsToUint(result) + 4) : result;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  const float x = trials[i].x, y = trials[i].y, z = trials[i].z;
  precise float sum = x + y, product = x * y, quotient = x / y, chain = product + z;
  const bool subnormal = (floatBitsToUint(x) & 0x7fffffffu) - 1u < 0x7fffffu;  // comparing floats may flush it to 0
  if (kFalsified == kFloatSubnormal && subnormal) product = 1.0;
  uint order = (x < y ? 1 : 0) | (min(x, y) == x ? 2 : 0) | (max(x, y) == x ? 4 : 0);
  if (kFalsified == kFloatOrder) order ^= 1;
  float high = x, low = trials[i].low;
  addExactly(high, low, y);
  addExactly(high, low, uintBitsToFloat(floatBitsToUint(x) & 0xffffff00u) * uintBitsToFloat(floatBitsToUint(z) & 0xffff0000u));
  addExactly(high, low, -x);
  const float apart = differenceInParts(x, trials[i].low, y, z),
              apartFirst = differenceInParts(x, trials[i].low, trials[0].x, trials[0].low);
  const Parts parts = partsOf(uvec2(trials[i].bits[0], trials[i].bits[1]));
  vec3 centre, halfExtent;
  boxAround(vec3(x), vec3(x + abs(x) / 10000.0), centre, halfExtent);
  outcomes[i] =
      FloatOutcome(reported(kFloatSum, sum), reported(kFloatProduct, product), reported(kFloatQuotient, quotient),
                   reported(kFloatChain, chain), reported(kFloatInverseRoot, inversesqrt(abs(y))),
                   reported(kFloatOfInteger, float(trials[i].integer)), reported(kFloatCopy, trials[i].copied), high,
                   kFalsified == kFloatAdded ? 0.0 : low, reported(kFloatDifference, apart), apartFirst, parts.bits,
                   kFalsified == kFloatParts ? 0.0 : parts.low, centre.x, kFalsified == kFloatBox ? 0.0 : halfExtent.x, order);
}
