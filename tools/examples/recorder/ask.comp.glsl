// Each crate asks how far it may fall in this frame.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "radar/query.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = 0) readonly buffer Transforms { vec4 transforms[]; };  // three rows each
layout(scalar, binding = 1) writeonly buffer Queries { RadarQuery queries[]; };
layout(push_constant) uniform Constants { uint crates, mesh; float fall, gap; } push;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= push.crates) return;
  RadarQuery query;
  for (uint row = 0; row < 3; ++row) query.worldFromMesh[row] = transforms[3 * i + row];
  query.direction = vec3(0.0, 0.0, -1.0);
  query.distance = push.fall + push.gap;
  query.mesh = push.mesh;
  query.mask = ~0u;
  query.exclude = i;  // itself: the crates are the objects 0, 1, 2, ...
  query.flags = 0;
  queries[i] = query;
}
