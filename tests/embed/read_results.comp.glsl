// A host's shader that reads recorded answers, without doubles if they are hidden from it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "radar/result.glsl"

layout(local_size_x = 64) in;

struct ShaderResult {
  uint status;
  uint object;
  uint flags;
  float t;
  float free;  // of a distance of 3
  float normal[3];
};

layout(scalar, binding = 0) readonly buffer Results { RadarResult results[]; };
layout(scalar, binding = 1) writeonly buffer ShaderResults { ShaderResult shaderResults[]; };
layout(push_constant) uniform Push { uint count; } push;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  const RadarResult r = results[i];
  shaderResults[i] = ShaderResult(r.status, r.object, r.flags, radarFloat(r.t), radarFree(r, 3.0),
                 float[3](radarFloat(r.normal[0]), radarFloat(r.normal[1]), radarFloat(r.normal[2])));
}
