// Computes with the float arithmetic that the search's error bounds assume; the CPU compares the results with its own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

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
  const bool subnormal = abs(x) < 1.1754944e-38 && x != 0.0;
  if (kFalsified == kFloatSubnormal && subnormal) product = 1.0;
  uint order = (x < y ? 1 : 0) | (min(x, y) == x ? 2 : 0) | (max(x, y) == x ? 4 : 0);
  if (kFalsified == kFloatOrder) order ^= 1;
  outcomes[i] =
      FloatOutcome(reported(kFloatSum, sum), reported(kFloatProduct, product), reported(kFloatQuotient, quotient),
                   reported(kFloatChain, chain), reported(kFloatInverseRoot, inversesqrt(abs(y))),
                   reported(kFloatOfInteger, float(trials[i].integer)), reported(kFloatCopy, trials[i].copied), order);
}
