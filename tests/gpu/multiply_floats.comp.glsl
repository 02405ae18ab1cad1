// Multiplies floats, given as bits, by a factor of bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"
#include "shaders/shared/workgroup.glsl"

layout(local_size_x = 1) in;

layout(scalar, binding = kSlotValues) readonly restrict buffer Values { uint values[]; };
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { uint results[]; };

layout(scalar, push_constant) uniform Push { ScalePush push; };

void main() {
  const uint i = workgroupIndex();
  if (i < push.count) results[i] = floatBitsToUint(uintBitsToFloat(values[i]) * uintBitsToFloat(push.factor));
}
