// The boxes of clusters in their sensor's frame: an invocation per cluster in reach.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kBindNodes) readonly restrict buffer Nodes { ClusterRecord nodes[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindPlacements) readonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kBindRefs) readonly restrict buffer Refs { ClusterRef refs[]; };
layout(scalar, binding = kBindBoxes) writeonly restrict buffer Boxes { RefBox boxes[]; };

layout(push_constant) uniform Push { uint count; uint groupsX; } push;

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX) * 64 + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Placement p = placements[refs[i].placement];
  const ClusterRecord node = nodes[meshes[p.mesh].firstNode + refs[i].node];
  for (int row = 0; row < 3; ++row) {
    float middle = p.frameFromMesh[row].w, reach = p.error;
    for (int k = 0; k < 3; ++k) {
      middle += p.frameFromMesh[row][k] * node.centre[k];
      reach += abs(p.frameFromMesh[row][k]) * node.halfExtent[k];
    }
    // `error` holds the rounding of a vertex; a box's corner rounds no more than twice that.
    reach += p.error;
    boxes[i].lo[row] = middle - reach;
    boxes[i].hi[row] = middle + reach;
    boxes[i].edge[row] = dot(p.frameFromMesh[row].xyz, node.edge);
  }
}
