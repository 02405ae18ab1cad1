// Reads the answers: an agent goes as many strides as are free.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "radar/query.glsl"
#include "radar/result.glsl"
#include "shared.h"
#include "random.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) buffer Agents { Agent agents[]; };
layout(scalar, binding = kAsked) readonly buffer Asked { uint asked; };
layout(std430, binding = kQueries) readonly buffer Queries { RadarQuery queries[]; };
layout(scalar, binding = kResults) readonly buffer Results { RadarResult results[]; };
layout(scalar, binding = kTransforms) writeonly buffer Transforms { vec4 transforms[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= asked) return;
  const RadarQuery query = queries[i];
  const uint id = query.exclude;
  Agent agent = agents[id];
  const float free = radarFree(results[i], kReach), stride = length(query.direction);
  const float strides = clamp(floor((free - kSkin) / stride), 0.0, float(kStrides));
  agent.place += strides * query.direction;
  agent.clear = free - strides * stride;
  // Now and then, and sooner if something is in the way, another goal.
  if (hash(id, push.frame) % (agent.clear < 1.0 ? 20u : 500u) == 0) ++agent.goal;
  agents[id] = agent;
  for (uint row = 0; row < 3; ++row) transforms[3 * id + row] = vec4(mat3(1.0)[row], agent.place[row]);
}
