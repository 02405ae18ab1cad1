// Linear workgroup numbers. Devices need only support 65535 workgroups along an axis, so gpu::Passes arranges more
// than that in rows.
#ifndef RADAR_WORKGROUP_GLSL
#define RADAR_WORKGROUP_GLSL

const uint kMostWorkgroups = 65535;

// The last row may be longer than needed, so compare the index with the number of items.
uint workgroupIndex() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// The VkDispatchIndirectCommand of `groups` workgroups.
uvec3 workgroupRows(uint groups) {
  const uint rows = max((groups + kMostWorkgroups - 1u) / kMostWorkgroups, 1u);
  return uvec3((groups + rows - 1u) / rows, rows, 1u);
}

#endif
