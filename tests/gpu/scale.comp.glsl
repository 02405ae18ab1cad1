// Multiplies each value by a factor and adds an offset.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"
#include "shaders/shared/workgroup.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 64;
layout(constant_id = 1) const uint kOffset = 0;

layout(scalar, binding = kSlotValues) readonly restrict buffer Values { uint values[]; };
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { uint results[]; };

layout(scalar, push_constant) uniform Push { ScalePush push; };

void main() {
  const uint i = workgroupIndex() * kLanes + gl_LocalInvocationID.x;
  if (i < push.count) results[i] = push.factor * values[i] + kOffset;
}
