// Writes the depth of pixel 0 in the workgroup's layer, in thousandths.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"

layout(local_size_x = 1) in;

layout(binding = kSlotDepth) uniform sampler2DArray depth;
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { uint results[]; };

void main() {
  results[gl_WorkGroupID.x] = uint(1000.0 * texelFetch(depth, ivec3(0, 0, gl_WorkGroupID.x), 0).x);
}
