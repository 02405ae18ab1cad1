// A pass of a merge sort: kSortRuns sorted runs become one, one invocation per part of the tree over objects. Parts of equal
// codes keep their order.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotUnsorted) readonly restrict buffer Unsorted { Part unsorted[]; };
layout(scalar, binding = kSlotSorted) writeonly restrict buffer Sorted { Part sorted[]; };

layout(push_constant) uniform PushConstants { SortPush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Part own = unsorted[i];
  const uint ownRun = i - i % push.run, first = i - i % (push.run * kSortRuns);
  uint place = first + (i - ownRun);
  for (uint n = 0; n < kSortRuns; ++n) {
    const uint run = min(first + n * push.run, push.count);
    if (run == ownRun) continue;
    // The parts of the run that come before this one.
    uint low = run, high = min(run + push.run, push.count);
    while (low < high) {
      const uint middle = low + (high - low) / 2, code = unsorted[middle].code;
      if (code < own.code || (code == own.code && run < ownRun)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    place += low - run;
  }
  sorted[place] = own;
}
