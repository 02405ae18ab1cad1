// Fits inner nodes of the tree over objects to their children, one depth per dispatch, deepest first; one invocation per
// node (docs/method.md, "A host's geometry").
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"
#include "box_around.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotObjectNodes) restrict buffer Nodes { ObjectNode nodes[]; };
layout(scalar, binding = kSlotFitNodes) readonly restrict buffer FitNodes { uint fitNodes[]; };

layout(push_constant) uniform PushConstants { FitPush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const uint n = fitNodes[push.first + i], left = nodes[n].link;
  const ObjectNode p = nodes[left], q = nodes[left + 1];
  const vec3 low = min(p.centre - p.halfExtent, q.centre - q.halfExtent),
             high = max(p.centre + p.halfExtent, q.centre + q.halfExtent);
  boxAround(low, high, nodes[n].centre, nodes[n].halfExtent);
}
