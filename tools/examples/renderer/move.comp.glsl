// Reads the answers: an agent takes the pose that it asked about, unless something is in it, and goes as far as is free.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "radar/query.glsl"
#include "radar/result.glsl"
#include "shared.h"
#include "random.glsl"
#include "grid.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kAgents) buffer Agents { Agent agents[]; };
layout(scalar, binding = kClaims) readonly buffer Claims { Claim claims[]; };
layout(std430, binding = kQueries) readonly buffer Queries { RadarQuery queries[]; };
layout(scalar, binding = kResults) readonly buffer Results { RadarResult results[]; };
layout(scalar, binding = kTransforms) writeonly buffer Transforms { vec4 transforms[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= asked) return;
  const RadarQuery query = queries[i];
  const RadarResult result = results[i];
  const uint id = query.exclude;
  Agent agent = agents[id];
  // There is surely no contact before lo, also if the device could not decide where exactly it is.
  const float lo = result.status == RADAR_STATUS_invalid ? 0.0 : min(radarFloat(result.lo), kReach);
  atomicAdd(answered, 1);
  if (result.status == RADAR_STATUS_invalid) atomicAdd(refused, 1);
  if (!(lo > 0.0)) {  // the turned pose is not free
    agent.stuck = 24;
    agent.clear = 0.0;
    agent.contact = agent.from = agent.place;
    agents[id] = agent;
    return;
  }

  const float stride = length(query.direction);
  const float strides = clamp(floor((lo - kSkin) / stride), 0.0, float(kStrides));
  agent.place += strides * query.direction;
  agent.heading = claims[id].heading;
  if (claims[id].keeps == 0) {
    agent.advanced = push.frame;
    agent.phase = (agent.phase + 1) % kCycle;
  }
  agent.clear = max(0.0, lo - strides * stride);
  agent.contact = agent.from = agent.place;
  agent.stuck -= min(agent.stuck, 1);
  // Now and then, and sooner if something is in the way, another goal.
  if (hash(id, push.frame) % (agent.clear < 1.0 ? 20u : 500u) == 0) ++agent.goal;
  if (result.status == RADAR_STATUS_hit) {
    agent.contact = vec3(radarFloat(result.point[0]), radarFloat(result.point[1]), radarFloat(result.point[2]));
    agent.normal = vec3(radarFloat(result.normal[0]), radarFloat(result.normal[1]), radarFloat(result.normal[2]));
    agent.from = agent.contact - query.direction / stride * agent.clear;
  }
  if (agent.clear >= kClose) {
    agent.side = 0;
  } else if (agent.side == 0) {  // the side to which the surface faces
    const float left = query.direction.x * agent.normal.y - query.direction.y * agent.normal.x;
    agent.side = abs(left) > 0.1 * stride ? int(sign(left)) : 1 - 2 * int(id % 2);
  }
  agents[id] = agent;
  for (uint row = 0; row < 3; ++row)
    transforms[3 * id + row] = vec4(query.worldFromMesh[row].xyz, agent.place[row]);
}
