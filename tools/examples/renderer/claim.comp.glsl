// Each agent steers: it chooses a turn and a stride, and claims the sphere around all that it may sweep in this frame.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "random.glsl"
#include "grid.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kClaims) writeonly buffer Claims { Claim claims[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

const float kRadians = 6.2831853 / kTurn;

// Walkers stay in the middle.
vec3 placeOf(uint goal, bool walks) {
  const vec2 side = 2.0 * vec2(unit(goal), unit(hash(goal, 1))) - 1.0;
  return vec3(side * (walks ? 24.0 : 0.9 * push.city), 3.0 + 20.0 * unit(hash(goal, 2)));
}

void main() {
  const uint id = gl_GlobalInvocationID.x;
  if (id >= push.agents) return;
  const Agent agent = agents[id];
  const bool walks = id < push.walkers;
  const uint chance = hash(id, push.frame);
  Claim claim;
  const vec3 way = placeOf(hash(id, agent.goal), walks) - agent.place;

  // Towards the goal, but away from what is close ahead.
  int turn = int(round(atan(way.y, way.x) / kRadians)) - agent.heading;
  turn = clamp((turn % kTurn + kTurn + kTurn / 2) % kTurn - kTurn / 2, -7, 7);
  if (length(way.xy) < 4.0) turn = 0;
  float slope = walks ? 0.0 : clamp(0.1 * way.z, -0.4, 0.4);
  if (agent.clear < kClose) {
    turn = 12 * agent.side;
    if (!walks && agent.normal.z > 0.7) slope = 0.4;
  }
  // There was no room for a turn: there always is for the pose that it has, in which it now moves to some side.
  int aside = 0;
  claim.keeps = min(agent.stuck, 1);
  if (agent.stuck > 0) {
    const uint anySide = hash(id, push.frame / 16);  // the same for some frames
    turn = 0;
    aside = int(anySide % kTurn);
    if (!walks) slope = 2.0 * unit(hash(anySide, 3)) - 1.0;
  }

  const int heading = (agent.heading + turn + kTurn) % kTurn;
  const float angle = kRadians * float(heading + aside);
  const float pace = agent.speed * (agent.stuck > 0 ? 0.6 : clamp(0.4 * agent.clear, 0.2, 1.0)) / kStrides;
  claim.stride = round(pace * vec3(cos(angle), sin(angle), slope) * kGrid) / kGrid;
  claim.heading = heading;
  claim.centre = agent.place + claim.stride * (0.5 * kStrides);
  claim.radius = agent.radius + length(claim.stride) * (0.5 * kStrides);
  claim.priority = chance;
  claim.link = atomicExchange(heads[bucketOf(ivec3(floor(claim.centre / kCell)))], id);
  claims[id] = claim;
}
