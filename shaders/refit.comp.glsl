// The boxes of a deformed mesh's clusters, and their longest edges: a workgroup per node, an invocation per triangle.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

layout(local_size_x = kCluster) in;

layout(scalar, binding = kBindPositions) readonly restrict buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uvec3 triangles[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindNodes) restrict buffer Nodes { ClusterRecord nodes[]; };

layout(push_constant) uniform Push { uint count; uint groupsX; uint mesh; } push;

shared vec3 lows[kCluster], highs[kCluster], edges[kCluster];

vec3 longer(vec3 p, vec3 q) { return dot(p, p) < dot(q, q) ? q : p; }

void main() {
  const uint n = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX, lane = gl_LocalInvocationID.x;
  if (n >= push.count) return;
  const MeshRecord mesh = meshes[push.mesh];
  const ClusterRecord node = nodes[mesh.firstNode + n];
  if (node.count == 0) return;
  const uvec3 corner = triangles[mesh.firstIndex / 3 + node.first + min(lane, node.count - 1)] + mesh.firstVertex;
  const vec3 a = positions[corner.x], b = positions[corner.y], c = positions[corner.z];
  lows[lane] = min(min(a, b), c);
  highs[lane] = max(max(a, b), c);
  edges[lane] = longer(longer(b - a, c - b), a - c);
  for (uint others = kCluster / 2; others != 0; others /= 2) {
    barrier();
    if (lane < others) {
      lows[lane] = min(lows[lane], lows[lane + others]);
      highs[lane] = max(highs[lane], highs[lane + others]);
      edges[lane] = longer(edges[lane], edges[lane + others]);
    }
  }
  if (lane != 0) return;
  const vec3 centre = 0.5 * lows[0] + 0.5 * highs[0];
  // Whatever the rounding.
  const vec3 reach = max(highs[0] - centre, centre - lows[0]) * 1.000001 + 2.4e-38;
  nodes[mesh.firstNode + n].centre = centre;
  nodes[mesh.firstNode + n].halfExtent = reach;
  nodes[mesh.firstNode + n].edge = edges[0];
}
