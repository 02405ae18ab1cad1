// Makes every answer invalid if a host's geometry has left its bounds: the search may have skipped parts of it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "interop.h"
#include "radar/result.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { RadarResult results[]; };
layout(scalar, binding = kSlotBoundsViolation) readonly restrict buffer BoundsViolations { BoundsViolation violation; };

layout(push_constant) uniform PushConstants { InvalidatePush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count || (violation.mesh == kNobody && violation.object == kNobody)) return;
  const uvec2 n = uvec2(0, 0x7ff80000u);
  results[i] = RadarResult(RADAR_STATUS_invalid, RADAR_TIER_select, RADAR_DETECTED_notLooked, 0, n, n, n, n, kNobody, kNobody,
                           kNobody, RADAR_FLAG_bounds, RADAR_FEATURE_none, RADAR_FEATURE_none, uvec2[3](n, n, n),
                           uvec2[3](n, n, n), n, n);
}
