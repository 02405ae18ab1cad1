// The sum, the difference and the product of each two floats.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"
#include "shaders/embed/float_bits.glsl"
#include "shaders/shared/workgroup.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kSlotValues) readonly restrict buffer Values { uint values[]; };
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { uint results[]; };

layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = workgroupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= count) return;
  const uint x = values[2 * i], y = values[2 * i + 1];
  results[3 * i] = floatSum(x, y);
  results[3 * i + 1] = floatDifference(x, y);
  results[3 * i + 2] = floatProduct(x, y);
}
