// Computes with the double arithmetic that solves pairs of triangles; the CPU compares the results with its own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/divide.glsl"
#include "interop.h"
#include "shared/double_double.glsl"
#include "shared/widen.glsl"

layout(local_size_x = kTrialGroup) in;
layout(constant_id = 0) const uint kFalsified = kNoOperation;

layout(scalar, binding = kSlotDoubleTrials) readonly restrict buffer Trials { DoubleTrial trials[]; };
layout(scalar, binding = kSlotDoubleOutcomes) writeonly restrict buffer Outcomes { DoubleOutcome outcomes[]; };

// The result, falsified if the check asks for that.
double reported(uint operation, double result) {
  const uvec2 bits = unpackDouble2x32(result);
  return kFalsified == operation ? packDouble2x32(uvec2(bits.x ^ 1, bits.y)) : result;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  const double x = trials[i].x, y = trials[i].y;
  const double total = x + y, multiplied = x * y, ratio = x / y;
  const dvec3 p = widened(floatBitsToUint(trials[i].p));
  const dvec4 row = dvec4(trials[i].row[0], trials[i].row[1], trials[i].row[2], trials[i].row[3]);
  const double placed = ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
  uint order = (x < y ? 1 : 0) | (min(x, y) == x ? 2 : 0) | (max(x, y) == x ? 4 : 0);
  if (kFalsified == kDoubleOrder) order ^= 1;
  float ofDouble = float(x);
  if (kFalsified == kFloatOfDouble) ofDouble = uintBitsToFloat(floatBitsToUint(ofDouble) + 4);
  const bool isOrdered = abs(x) >= abs(y);
  const double rests[3] = double[3](sum(x, y).low, quickSum(isOrdered ? x : y, isOrdered ? y : x).low, product(x, y).low);
  const DoubleDouble xy = product(x, y), one = DoubleDouble(x, 0.0LF), other = DoubleDouble(y, 0.0LF);
  const DoubleDouble chain = times(plus(one, xy), minus(xy, other));
  float high, low;
  split(x, high, low);
  outcomes[i] =
      DoubleOutcome(reported(kDoubleSum, total), reported(kDoubleProduct, multiplied), reported(kDoubleQuotient, ratio),
                    reported(kDoubleCorrected, correctedQuotient(x, y)), reported(kDoublePlaced, placed),
                    reported(kDoubleOfFloat, p.x), reported(kDoubleCopy, trials[i].row[0]),
                    double[3](reported(kDoubleRests, rests[0]), rests[1], rests[2]), double[2](chain.high, chain.low), ofDouble,
                    high, kFalsified == kDoubleSplit ? 0.0 : low, order);
}
