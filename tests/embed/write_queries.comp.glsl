// Stands for a host's shader that asks queries: `number` of them, in a row, from `height`.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "radar/query.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) writeonly buffer Queries { RadarQuery queries[]; };
layout(std430, binding = 1) writeonly buffer Number { uint written; };
layout(push_constant) uniform Push {
  uint number;
  float height;
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i == 0) written = number;
  if (i >= number) return;
  RadarQuery query;
  query.worldFromMesh = vec4[3](vec4(0.5, 0.0, 0.0, 0.25 * float(i)), vec4(0.0, 0.5, 0.125, 0.0), vec4(0.0, -0.125, 0.5, height));
  query.direction = vec3(0.0, 0.015625 * float(i % 4), 1.0);
  query.distance = 20.0;
  query.mesh = 0;
  query.mask = ~0u;
  query.exclude = i % 2 == 0 ? RADAR_NO_EXCLUSION : i % 8;
  query.flags = i % 5 == 4 ? RADAR_ANY_HIT : 0;
  queries[i] = query;
}
