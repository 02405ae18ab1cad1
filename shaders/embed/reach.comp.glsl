// Adapts sensors that the CPU has encoded to a scene of which it does not know where the objects are, one invocation per
// sensor: widens the box for the farthest object, or finds the sensor out of range, as engine/contact/sensors.cpp does.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "interop.h"
#include "shared/workgroup.glsl"
#include "world.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotSensors) restrict buffer Sensors { Sensor sensors[]; };
layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };

layout(push_constant) uniform PushConstants { ReachPush push; };

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const float farthest = farthestFrom(sensors[i].centre), unscale = sensors[i].unscale;
  // Scaled, every contact is nearer than 2^40, and a clearance is 0 or at least 2^-40 of the scene's extent.
  const float clearance = sensors[i].frame[0].w;
  const bool inRange = farthest <= 5.5e11 * unscale && farthest <= 9.6e24 &&
                       (clearance == 0.0 || clearance * unscale >= 9.2e-13 * (2.0 * unscale + farthest));
  if (!inRange) states[i].flags |= kSearchOutOfRange;
  // 2^-37, for the velocity that sensorBoxOf (contact/nodes.glsl) raises.
  sensors[i].halfExtent = 1.000001 * (sensors[i].halfExtent + 7.3e-12 * (farthest + clearance * unscale));
}
