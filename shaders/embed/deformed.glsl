// The list of meshes that a host deforms.
layout(scalar, binding = kSlotDeformed) readonly restrict buffer DeformedMeshes { Deformed deformed[]; };

// The mesh that a workgroup takes: the last of `count` whose workgroups begin with it or before.
uint deformedOf(uint group, uint kernel, uint count) {
  uint first = 0, end = count;
  while (end - first > 1) {
    const uint middle = (first + end) / 2;
    if (deformed[middle].firstGroup[kernel] <= group) {
      first = middle;
    } else {
      end = middle;
    }
  }
  return first;
}
