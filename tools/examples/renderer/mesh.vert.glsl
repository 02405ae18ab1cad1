// Agents and buildings: the transforms are those that the search has read and the agents have written.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(scalar, binding = kAgents) readonly buffer Agents { Agent agents[]; };
layout(scalar, binding = kTransforms) readonly buffer Transforms { vec4 transforms[]; };
layout(scalar, binding = kVertices) readonly buffer Vertices { vec3 vertices[]; };
layout(push_constant, scalar) uniform Constants { Push push; };

layout(location = 0) out vec3 world;
layout(location = 1) out vec4 colour;  // w: 1 for buildings

// An agent is red where nothing is free, over amber and green to blue.
vec4 colourOf(uint object) {
  const vec3 stone[4] = vec3[4](vec3(0.52, 0.44, 0.34), vec3(0.33, 0.36, 0.42), vec3(0.58, 0.50, 0.38), vec3(0.44, 0.30, 0.24));
  if (object >= push.agents) return vec4(stone[object * 7 / 3 % 4], 1.0);
  const vec3 tints[4] = vec3[4](vec3(0.90, 0.03, 0.03), vec3(1.0, 0.45, 0.02), vec3(0.12, 0.60, 0.12), vec3(0.02, 0.30, 0.75));
  const float at = clamp(agents[object].clear / 3.0, 0.0, 2.999);
  return vec4(mix(tints[int(at)], tints[int(at) + 1], fract(at)), 0.0);
}

vec4 clipOf(vec3 there) {
  const vec3 ahead = normalize(vec3(0.0, 0.0, 5.0) - push.eye), right = normalize(cross(ahead, vec3(0.0, 0.0, 1.0)));
  const float zoom = 1.7, near = 0.25, far = 1500.0, depth = dot(ahead, there);
  return vec4(zoom / push.aspect * dot(right, there), zoom * dot(cross(ahead, right), there), far / (far - near) * (depth - near), depth);
}

void main() {
  const vec4 at = vec4(vertices[gl_VertexIndex], 1.0);
  for (uint row = 0; row < 3; ++row) world[row] = dot(transforms[3 * gl_InstanceIndex + row], at);
  colour = colourOf(gl_InstanceIndex);
  gl_Position = clipOf(world - push.eye);
}
