// Builds a tree above the sorted parts of the tree over objects, and fits it to them, one invocation per part, which climbs as
// long as it is the second of two children to arrive. The tree is the radix tree of the codes: of equal ones, of the parts'
// places. C. Apetrei, "Fast and simple agglomerative LBVH construction", 2014; docs/method.md, "A host's geometry".
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"
#include "box_around.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotObjectNodes) coherent restrict buffer Nodes { ObjectNode nodes[]; };
layout(scalar, binding = kSlotSorted) readonly restrict buffer Sorted { Part sorted[]; };
// By inner nodes: where the parts of the child that arrived first begin, if it is the left one, or end; kNobody: none has.
layout(scalar, binding = kSlotReached) coherent restrict buffer Reached { uint reached[]; };

layout(push_constant) uniform PushConstants { FitPush push; };

// How a part differs from the next: at the more significant a bit, the higher up their parts of the tree meet.
uvec2 differenceAt(uint i) { return uvec2(sorted[i].code ^ sorted[i + 1].code, i ^ (i + 1)); }
bool isLess(uvec2 p, uvec2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); }

ObjectNode nodeAround(ObjectNode p, ObjectNode q, uint link) {
  const vec3 low = min(p.centre - p.halfExtent, q.centre - q.halfExtent),
             high = max(p.centre + p.halfExtent, q.centre + q.halfExtent);
  ObjectNode node;
  boxAround(low, high, node.centre, node.halfExtent);
  node.link = link;
  node.pad = 0;
  return node;
}

shared uint climbing;  // invocations of the workgroup that do

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x, last = push.count - 1;
  bool climbs = i <= last;
  if (gl_LocalInvocationID.x == 0) climbing = 0;
  barrier();
  if (climbs) atomicAdd(climbing, 1);
  barrier();
  ObjectNode own = nodes[sorted[min(i, last)].node];
  // Of the parts below: the first and the last.
  uint from = i, to = i;
  // All take each turn: lavapipe waits at a memory barrier for the whole workgroup.
  while (climbing != 0) {
    bool isLeft = false;
    uint parent = 0;  // an inner node is named by the last part below its left child
    if (climbs) {
      isLeft = from == 0 || (to != last && isLess(differenceAt(to), differenceAt(from - 1)));
      parent = isLeft ? to : from - 1;
      nodes[push.first + 2 * parent + (isLeft ? 0 : 1)] = own;
    }
    memoryBarrierBuffer();
    barrier();
    uint other = kNobody;
    if (climbs) other = atomicExchange(reached[parent], isLeft ? from : to);
    memoryBarrierBuffer();
    const bool meets = other != kNobody;
    if (meets) {
      own = nodeAround(own, nodes[push.first + 2 * parent + (isLeft ? 1 : 0)], push.first + 2 * parent);
      from = isLeft ? from : other;
      to = isLeft ? other : to;
    }
    const bool isRoot = meets && from == 0 && to == last;
    if (isRoot) nodes[0] = own;
    if (climbs && (!meets || isRoot)) {
      climbs = false;
      atomicAdd(climbing, ~0u);
    }
    barrier();
  }
}
