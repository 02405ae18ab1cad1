// Each agent chooses a stride, and claims the sphere around all that it may sweep in this frame.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "grid.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kClaims) writeonly buffer Claims { Claim claims[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

void main() {
  const uint id = gl_GlobalInvocationID.x;
  if (id >= push.agents) return;
  const Agent agent = agents[id];
  // Towards the goal; along what is close ahead; and to some side where that is not enough.
  const vec3 goal = random(hash(id, agent.goal)) * vec3(0.9 * push.city, 0.9 * push.city, 10.0) + vec3(0.0, 0.0, 13.0);
  vec3 way = normalize(goal - agent.place);
  if (agent.clear < kClose) way -= min(0.0, dot(way, agent.normal)) * agent.normal;
  if (agent.clear < kClose) way += 0.3 * random(hash(id, push.frame / 32));
  if (agent.clear < 2.0 * kSkin) way = random(hash(id, push.frame / 8));
  const float pace = (0.13 + 0.06 * float(hash(id, 7) % 8u) / 8.0) * clamp(0.4 * agent.clear, 0.2, 1.0) / kStrides;
  Claim claim;
  claim.stride = round(pace * normalize(way) * kGrid) / kGrid;
  claim.centre = agent.place + claim.stride * (0.5 * kStrides);
  claim.radius = push.radius + length(claim.stride) * (0.5 * kStrides);
  claim.link = atomicExchange(heads[bucketOf(ivec3(floor(claim.centre / kCell)))], id + 1);
  claims[id] = claim;
}
