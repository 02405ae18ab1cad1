// Daylight: a sun, a sky above and the ground below; the faces' own normals; haze in the distance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 world;
layout(location = 1) in vec4 colour;
layout(location = 0) out vec4 shown;
layout(push_constant, scalar) uniform Constants { Push push; };

// Windows give walls a scale; asphalt, and grass around.
vec3 surfaceOf(vec3 normal) {
  const vec2 at = vec2(abs(normal.x) > 0.5 ? world.y : world.x, world.z) / vec2(1.1, 1.5);
  const vec2 wide = fwidth(at), off = abs(fract(at) - 0.5);
  const vec2 pane = 1.0 - smoothstep(vec2(0.3) - wide, vec2(0.3) + wide, off);
  if (abs(normal.z) < 0.5)
    return mix(colour.rgb, vec3(0.05, 0.08, 0.12), 0.85 * mix(pane.x * pane.y, 0.38, smoothstep(0.25, 0.8, max(wide.x, wide.y))));
  if (world.z > 0.5) return colour.rgb;
  const float outside = max(abs(world.x), abs(world.y)) - push.city;
  return mix(vec3(0.16, 0.165, 0.17), vec3(0.10, 0.20, 0.035), smoothstep(0.0, 1.5, outside));
}

void main() {
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  const vec3 back = push.eye - world;
  if (dot(normal, back) < 0.0) normal = -normal;
  const vec3 base = colour.w > 0.5 ? surfaceOf(normal) : colour.rgb;
  const vec3 sky = mix(vec3(0.10, 0.085, 0.07), vec3(0.17, 0.24, 0.37), 0.5 + 0.5 * normal.z);
  const vec3 sun = vec3(1.2, 1.05, 0.82) * max(0.0, dot(normal, vec3(0.48, 0.36, 0.8)));
  const vec3 lit = mix(vec3(0.36, 0.52, 0.74), base * (sky + sun), exp(-length(back) / (120.0 + 4.0 * push.city)));
  // A film's curve, and the encoding of sRGB.
  shown = vec4(pow(clamp(lit * (2.5 * lit + 0.03) / (lit * (2.4 * lit + 0.6) + 0.14), 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
