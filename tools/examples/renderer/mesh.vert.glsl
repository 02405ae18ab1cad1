// Agents, buildings and terrain: the transforms are those that the search has read and the agents have written.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "random.glsl"
#include "tint.glsl"

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kTransforms) readonly buffer Transforms { vec4 transforms[]; };
layout(scalar, binding = kVertices) readonly buffer Vertices { vec4 vertices[]; };
layout(scalar, binding = kSkinned) readonly buffer Skinned { vec3 skinned[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

layout(location = 0) out vec3 world;
layout(location = 1) out vec3 colour;
layout(location = 2) out float light;

vec3 colourOf(uint instance) {
  if (push.kind <= kDrone) return tintOf(agents[instance].clear);
  const vec3 stone[4] = vec3[4](vec3(0.52, 0.44, 0.34), vec3(0.33, 0.36, 0.42), vec3(0.58, 0.50, 0.38), vec3(0.44, 0.30, 0.24));
  return stone[hash(instance, 7) % 4u];
}

void main() {
  const uint instance = gl_InstanceIndex;
  vec4 at = vertices[gl_VertexIndex];
  light = push.kind == kTerrain ? at.w : 1.0;
  if (push.kind == kWalker) {
    const uint next = agents[instance].advanced == push.frame ? 1 : 0;
    at.xyz = skinned[(2 * instance + next) * push.walkerVertices + gl_VertexIndex];
  }
  for (uint row = 0; row < 3; ++row) world[row] = dot(transforms[3 * instance + row], vec4(at.xyz, 1.0));
  colour = colourOf(instance);
  gl_Position = push.clipFromWorld * vec4(world, 1.0);
}
