// Shared by kernel_test and its shaders.
#ifndef RADAR_KERNEL_INTEROP_H
#define RADAR_KERNEL_INTEROP_H

#include "shaders/shared/slot.h"

#ifdef __cplusplus
namespace radar::test {
using uint = uint32_t;
#endif

// Two texels of RGBA32.
struct Node {
  uint word[8];
};

// A VkDispatchIndirectCommand.
struct Groups {
  uint x, y, z;
};

struct ScalePush {
  uint count;
  uint factor;
};

INTEROP_SLOT(kSlotValues, 0, uint);
INTEROP_SLOT(kSlotNodes, 3, Node);
INTEROP_SLOT(kSlotResults, 7, uint);
INTEROP_SLOT(kSlotGroups, 2, Groups);
INTEROP_SLOT(kSlotDepth, 5, radar::gpu::SampledImage);

#ifdef __cplusplus
}  // namespace radar::test
#endif
#endif
