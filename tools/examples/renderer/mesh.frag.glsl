// Daylight: a sun, a sky above and the ground below; the faces' own normals; haze in the distance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 world;
layout(location = 1) in vec3 colour;
layout(location = 2) in float light;
layout(location = 0) out vec4 shown;
layout(push_constant, scalar) uniform Constants { Push push; };

const vec3 kSun = vec3(0.48, 0.36, 0.8);  // of unit length; world.cpp casts shadows along it

// 1 where `at` is less than `most`, 0 where it is more; `wide`, a pixel, in between.
float below(float at, float most, float wide) {
  return 1.0 - smoothstep(most - wide, most + wide, at);
}

// Windows give walls a scale.
vec3 wallOf(vec3 base, vec3 normal) {
  const vec2 at = vec2(abs(normal.x) > 0.5 ? world.y : world.x, world.z) / vec2(1.1, 1.5);
  const vec2 wide = fwidth(at), off = abs(fract(at) - 0.5);
  const float pane = below(off.x, 0.3, wide.x) * below(off.y, 0.32, wide.y);
  const float far = smoothstep(0.25, 0.8, max(wide.x, wide.y));
  return mix(base, vec3(0.05, 0.08, 0.12), 0.85 * mix(pane, 0.38, far));
}

// Pavements and roads, a paved square in the middle, and grass around.
vec3 groundOf() {
  const vec2 block = abs(fract(world.xy / kPitch) - 0.5) * kPitch;
  const vec2 middle = abs(world.xy);
  const float outside = max(middle.x, middle.y) - push.city;
  const float wide = max(fwidth(world.x), fwidth(world.y));
  const float paved = max(below(max(block.x, block.y), 6.4, wide), below(max(middle.x, middle.y), 15.4, wide));
  const vec2 slab = abs(fract(world.xy / 2.0) - 0.5);
  vec3 ground = mix(vec3(0.075, 0.08, 0.09), vec3(0.30, 0.29, 0.27), paved);
  ground *= 1.0 - 0.16 * paved * smoothstep(0.46, 0.49, max(slab.x, slab.y)) * exp(-0.02 * distance(push.eye, world));
  const vec3 grass = mix(vec3(0.10, 0.20, 0.035), vec3(0.20, 0.19, 0.09), smoothstep(4.0, 26.0, world.z));
  return mix(ground, grass, smoothstep(0.0, 1.5, outside));
}

vec3 shownFrom(vec3 lit) {  // a film's curve, and the encoding of sRGB
  return pow(clamp(lit * (2.5 * lit + 0.03) / (lit * (2.4 * lit + 0.6) + 0.14), 0.0, 1.0), vec3(1.0 / 2.2));
}

void main() {
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  const vec3 back = push.eye - world;
  if (dot(normal, back) < 0.0) normal = -normal;
  vec3 base = colour;
  if (push.kind == kBuilding && abs(normal.z) < 0.5) base = wallOf(base, normal);
  if (push.kind == kTerrain) base = groundOf();
  const float nearGround = push.kind == kBuilding ? mix(0.55, 1.0, smoothstep(0.0, 9.0, world.z)) : 1.0;
  const vec3 sky = mix(vec3(0.10, 0.085, 0.07), vec3(0.17, 0.24, 0.37), 0.5 + 0.5 * normal.z) * nearGround;
  const vec3 sun = vec3(1.2, 1.05, 0.82) * max(0.0, dot(normal, kSun)) * light;
  const vec3 haze = vec3(0.36, 0.52, 0.74);
  shown = vec4(shownFrom(mix(haze, base * (sky + sun), exp(-length(back) / (120.0 + 4.0 * push.city)))), 1.0);
}
