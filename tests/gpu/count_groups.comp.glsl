// Writes the command of an indirect dispatch.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "kernel_interop.h"
#include "shaders/shared/workgroup.glsl"

layout(local_size_x = 1) in;

layout(scalar, binding = kSlotGroups) writeonly restrict buffer Command { Groups groups; };

layout(scalar, push_constant) uniform Push { uint count; };

void main() {
  const uvec3 rows = workgroupRows(count);
  groups = Groups(rows.x, rows.y, rows.z);
}
