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
  for (int i = 0; i < 27; ++i) {
    uint other = heads[bucketOf(cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1)];
    while (other != RADAR_NO_EXCLUSION) {
      const Claim theirs = claims[other];
      const bool before = theirs.priority < claim.priority || (theirs.priority == claim.priority && other < id);
      if (before && distance(theirs.centre, claim.centre) < theirs.radius + claim.radius) return false;
      other = theirs.link;
    }
  }
  return true;
}

void main() {
  const uint id = gl_GlobalInvocationID.x;
  if (id >= push.agents) return;
  const Claim claim = claims[id];
  if (!mayMove(id, claim)) return;
  const Agent agent = agents[id];
  const float angle = 6.2831853 / kTurn * float(claim.heading);
  const vec2 ahead = round(vec2(cos(angle), sin(angle)) * kGrid) / kGrid;
  RadarQuery query;
  query.worldFromMesh = vec4[3](vec4(ahead.x, -ahead.y, 0.0, agent.place.x), vec4(ahead.y, ahead.x, 0.0, agent.place.y),
                                vec4(0.0, 0.0, 1.0, agent.place.z));
  query.direction = claim.stride;
  query.distance = kReach;
  query.mesh = claim.keeps == 1 ? agent.body : agent.sensor;
  query.mask = ~0u;
  query.exclude = id;  // objects 0, 1, 2, ... are the agents
  query.flags = 0;
  queries[atomicAdd(asked, 1)] = query;
}
