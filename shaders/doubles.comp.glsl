// The self-test of doubles: what the solver relies on, done once with numbers whose results the host knows.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(local_size_x = kSums) in;

layout(scalar, binding = kSlotSums) readonly restrict buffer Sums { Sum sums[]; };
layout(scalar, binding = kSlotSumResults) writeonly restrict buffer Results { SumResult results[]; };

void main() {
  const uint i = gl_LocalInvocationID.x;
  const double x = sums[i].x, y = sums[i].y;
  precise double sum = x + y, product = x * y, quotient = x / y;
  const dvec3 p = dvec3(sums[i].p);
  precise double placed = ((sums[i].row[0] * p.x + sums[i].row[1] * p.y) + sums[i].row[2] * p.z) + sums[i].row[3];
  results[i] = SumResult(sum, product, quotient, placed, double(float(x)));
}
