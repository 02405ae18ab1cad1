// Each crate falls as far as the engine found free. All fall alike, so a fall past others at rest is one past all.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "radar/result.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = 0) buffer Transforms { vec4 transforms[]; };
layout(scalar, binding = 2) readonly buffer Results { RadarResult results[]; };
layout(push_constant) uniform Constants { uint crates, mesh; float fall, gap; } push;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= push.crates) return;
  // The new place is rounded, so a crate stops short of what it would touch.
  transforms[3 * i + 2].w -= max(0.0, radarFree(results[i], push.fall + push.gap) - push.gap);
}
