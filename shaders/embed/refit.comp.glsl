// Recomputes the boxes and slabs of deformed meshes' nodes, one depth per dispatch, deepest first; one invocation per node.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/scene.glsl"
#include "shared/workgroup.glsl"
#include "box_around.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotMeshNodes) restrict buffer Nodes { MeshNode nodes[]; };
layout(scalar, binding = kSlotRefitNodes) readonly restrict buffer RefitNodes { RefitNode refitNodes[]; };

layout(push_constant) uniform PushConstants { RefitPush push; };

// Bound on the error of a slab, in any rounding direction: it is computed from sums of three products of coordinates below 4.
const float kSlabError = 8e-6;

struct Range {
  float least;
  float most;
};

void setBox(uint n, vec3 low, vec3 high) { boxAround(low, high, nodes[n].centre, nodes[n].halfExtent); }

// The slab of a normal of 0 holds every vertex.
void setSlab(uint n, vec3 normal, Range range) {
  const bool hasNormal = normal != vec3(0.0);
  nodes[n].normal = normal;
  nodes[n].slabMiddle = hasNormal ? 0.5 * (range.least + range.most) : 0.0;
  nodes[n].slabHalf = hasNormal ? 0.5 * (range.most - range.least) * 1.000001 + kSlabError : 0.0;
}

// No component is subnormal, so that no use of it may differ from another.
vec3 unitOrZero(vec3 v) {
  const float squared = dot(v, v);
  const vec3 unit = squared > 1e-30 && squared < 1e30 ? v * inversesqrt(squared) : vec3(0.0);
  return mix(vec3(0.0), unit, greaterThan(abs(unit), vec3(1.2e-38)));
}

void refitLeaf(MeshRecord mesh, uint n, uint link) {
  const uint triangles = (link & kLinkPair) != 0 ? 2 : 1;
  vec3 q[6];
  vec3 sum = vec3(0.0);
  for (uint t = 0; t < 2; ++t) {
    const uvec4 corner = triangleAt((link & kLinkItem) + min(t, triangles - 1));
    for (uint i = 0; i < 3; ++i) q[3 * t + i] = (vertexAt(corner[i]) - mesh.origin) * mesh.perUnit;
    sum += cross(q[3 * t + 1] - q[3 * t], q[3 * t + 2] - q[3 * t]);
  }
  const vec3 normal = unitOrZero(sum);
  vec3 low = q[0], high = q[0];
  Range range = Range(dot(normal, q[0]), dot(normal, q[0]));
  for (uint i = 1; i < 6; ++i) {
    low = min(low, q[i]);
    high = max(high, q[i]);
    range = Range(min(range.least, dot(normal, q[i])), max(range.most, dot(normal, q[i])));
  }
  setBox(n, low, high);
  setSlab(n, normal, range);
}

// Bounds a node's vertices along `normal` by its slab and its box.
Range rangeOf(MeshNode node, vec3 normal) {
  const float along = dot(normal, node.normal);
  const vec3 rest = normal - along * node.normal;
  const float middle = along * node.slabMiddle + dot(rest, node.centre);
  const float extent = abs(along) * node.slabHalf + dot(abs(rest), node.halfExtent);
  return Range(middle - extent, middle + extent);
}

void refitParent(uint n, uint link) {
  const MeshNode p = nodes[link], q = nodes[link + 1];
  setBox(n, min(p.centre - p.halfExtent, q.centre - q.halfExtent), max(p.centre + p.halfExtent, q.centre + q.halfExtent));
  // The mean of the children's normals, weighted by size.
  const vec3 normal = unitOrZero(dot(p.halfExtent, p.halfExtent) * p.normal + dot(q.halfExtent, q.halfExtent) * q.normal);
  const Range rangeP = rangeOf(p, normal), rangeQ = rangeOf(q, normal);
  setSlab(n, normal, Range(min(rangeP.least, rangeQ.least), max(rangeP.most, rangeQ.most)));
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const RefitNode own = refitNodes[push.first + i];
  const MeshRecord mesh = meshes[own.mesh];
  const uint n = mesh.firstNode + own.node;
  const uint link = nodes[n].link;
  if ((link & kLinkLeaf) != 0) {
    refitLeaf(mesh, n, link);
  } else {
    refitParent(n, link);
  }
}
