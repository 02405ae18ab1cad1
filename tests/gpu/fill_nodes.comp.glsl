// Writes nodes as storage that other shaders read as texels. The words of all nodes count up from `first`.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"

layout(local_size_x = 1) in;

layout(scalar, binding = kSlotNodes) writeonly restrict buffer Nodes { Node nodes[]; };

layout(scalar, push_constant) uniform Push { uint first; };

void main() {
  for (uint k = 0; k < 8; ++k) nodes[gl_WorkGroupID.x].word[k] = first + 8 * gl_WorkGroupID.x + k;
}
