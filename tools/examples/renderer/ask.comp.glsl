// Agents of least priority among those whose claims overlap theirs may move, and ask how far. All others rest, so a sweep
// past everything else at rest is a sweep past everything.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "radar/query.glsl"
#include "shared.h"
#include "grid.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kClaims) readonly buffer Claims { Claim claims[]; };
layout(std430, binding = kQueries) writeonly buffer Queries { RadarQuery queries[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

bool mayMove(uint id, Claim claim) {
  const ivec3 cell = ivec3(floor(claim.centre / kCell));
  const uint priority = hash(id, push.frame);
  for (int i = 0; i < 27; ++i) {
    Claim theirs;
    for (uint next = heads[bucketOf(cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1)]; next != 0; next = theirs.link) {
      theirs = claims[next - 1];
      const uint other = hash(next - 1, push.frame);
      const bool before = other < priority || (other == priority && next - 1 < id);
      if (before && distance(theirs.centre, claim.centre) < theirs.radius + claim.radius) return false;
    }
  }
  return true;
}

void main() {
  const uint id = gl_GlobalInvocationID.x;
  if (id >= push.agents || !mayMove(id, claims[id])) return;
  const vec3 place = agents[id].place;
  RadarQuery query;
  for (uint row = 0; row < 3; ++row) query.worldFromMesh[row] = vec4(mat3(1.0)[row], place[row]);
  query.direction = claims[id].stride;
  query.distance = kReach;
  query.mesh = push.mesh;
  query.mask = ~0u;
  query.exclude = id;
  query.flags = 0;
  queries[atomicAdd(asked, 1)] = query;
}
