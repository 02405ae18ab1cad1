// Linear workgroup numbers. Devices are only required to take 65535 workgroups along an axis, so gpu::KernelArguments
// lays out more than that in rows.
#ifndef RADAR_WORKGROUP_GLSL
#define RADAR_WORKGROUP_GLSL

// The last row may be longer than needed: compare the index with the number of items.
uint workgroupIndex() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// What an indirect dispatch of `groups` workgroups needs in its VkDispatchIndirectCommand.
uvec3 workgroupRows(uint groups) {
  const uint rows = max((groups + 65534u) / 65535u, 1u);
  return uvec3((groups + rows - 1u) / rows, rows, 1u);
}

#endif
