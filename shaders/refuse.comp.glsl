// Where something of a host's geometry has left its bounds, no answer counts: what was not in reach might be.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "radar/result.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { RadarResult results[]; };
#include "workgroup.glsl"
layout(scalar, binding = kSlotStray) readonly restrict buffer Strays { Stray stray; };

layout(push_constant) uniform Push { uint count; } push;

void main() {
  const uint i = workgroupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= push.count || (stray.mesh == kNobody && stray.object == kNobody)) return;
  const uvec2 n = uvec2(0, 0x7ff80000u);
  results[i] = RadarResult(RADAR_INVALID, RADAR_TIER_SELECT, RADAR_NOT_LOOKED, 0, n, n, n, n, kNobody, kNobody, kNobody,
                           RADAR_OUT_OF_BOUNDS, uvec2[3](n, n, n), uvec2[3](n, n, n), n);
}
