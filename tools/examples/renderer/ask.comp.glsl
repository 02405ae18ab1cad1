// In each frame all agents that move go the same way, another one each time: those whom it brings nearer to their goals ask
// how far. Of two that go the same way, neither gets farther relative to the other than its own sweep past the other at
// rest, so they do not meet.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "radar/query.glsl"
#include "shared.h"
#include "random.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kAsked) buffer Asked { uint asked; };
layout(std430, binding = kQueries) writeonly buffer Queries { RadarQuery queries[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

void main() {
  const uint id = gl_GlobalInvocationID.x;
  if (id >= push.agents) return;
  const Agent agent = agents[id];
  const vec3 goal = random(hash(id, agent.goal)) * vec3(0.9 * push.city, 0.9 * push.city, 10.0) + vec3(0.0, 0.0, 13.0);
  const vec3 way = normalize(random(hash(push.frame, 0)));
  if (dot(way, goal - agent.place) < 0.2 * distance(goal, agent.place)) return;
  RadarQuery query;
  for (uint row = 0; row < 3; ++row) query.worldFromMesh[row] = vec4(mat3(1.0)[row], agent.place[row]);
  query.direction = round(kStride * way * kGrid) / kGrid;
  query.distance = kReach;
  query.mesh = push.mesh;
  query.mask = ~0u;
  query.exclude = id;
  query.flags = 0;
  queries[atomicAdd(asked, 1)] = query;
}
