// For each agent: from the point of it that will touch something to where it will, and the normal there.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "tint.glsl"

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

layout(location = 0) out vec3 colour;

void main() {
  const Agent agent = agents[gl_InstanceIndex];
  const bool any = agent.from != agent.contact;
  const vec3 ends[4] = vec3[4](agent.from, agent.contact, agent.contact, agent.contact + (any ? 0.8 : 0.0) * agent.normal);
  colour = gl_VertexIndex < 2 ? tintOf(agent.clear) : vec3(1.0);
  gl_Position = push.clipFromWorld * vec4(ends[gl_VertexIndex], 1.0);
}
