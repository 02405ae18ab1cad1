// Skins each walker twice: as it stands (its object in the scene), and in the next phase of its walk (the sensor with which
// it asks whether there is room for that).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kVertices) readonly buffer Vertices { vec4 rest[]; };  // w: the leg, and how far down it
layout(scalar, binding = kSkinned) writeonly buffer Skinned { vec3 skinned[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

void main() {
  const uint i = gl_GlobalInvocationID.x, copy = i / push.walkerVertices;
  if (copy >= 2 * push.walkers) return;
  const vec4 at = rest[i % push.walkerVertices];
  const float phase = 6.2831853 / kCycle * float((agents[copy / 2].phase + int(copy % 2)) % kCycle);
  vec3 p = at.xyz;
  if (at.w < 0.0) {
    p.z += 0.06 * sin(2.0 * phase);
  } else {
    const float leg = floor(at.w), down = at.w - leg, step = phase + (leg == 0.0 || leg == 3.0 ? 0.0 : 3.1415927);
    const float hip = 0.35, angle = 0.42 * down * sin(step), lift = 0.5 * down * down * max(0.0, cos(step));
    const float x = p.x, z = p.z - hip, pivot = sign(x) * 0.75;
    p.x = pivot + (x - pivot) * cos(angle) - z * sin(angle);
    p.z = hip + (x - pivot) * sin(angle) + z * cos(angle) + lift;
  }
  skinned[i] = round(p * kVertexGrid) / kVertexGrid;
}
