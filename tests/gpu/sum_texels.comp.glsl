// Adds the words of each node, read as two texels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"

layout(local_size_x = 1) in;

layout(binding = kSlotNodes) uniform utextureBuffer nodes;
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { uint results[]; };

void main() {
  const int node = int(gl_WorkGroupID.x);
  const uvec4 sums = texelFetch(nodes, 2 * node) + texelFetch(nodes, 2 * node + 1);
  results[node] = sums.x + sums.y + sums.z + sums.w;
}
