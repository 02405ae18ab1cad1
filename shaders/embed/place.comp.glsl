// Places sensors that the CPU has encoded, of meshes that a host deforms without bounds, one invocation per sensor: only the
// device knows how large they are (engine/contact/sensors.cpp).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "contact/interop.h"
#include "interop.h"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotSensors) restrict buffer Sensors { Sensor sensors[]; };
layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotSweeps) restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotDeformedSensors) readonly restrict buffer DeformedSensors { DeformedSensor deformedSensors[]; };
#include "transform.glsl"
#include "placement.glsl"
#include "shared/workgroup.glsl"
#include "world.glsl"
#include "sensor.glsl"
#ifndef RADAR_NO_DOUBLES
#include "contact/magnitude.glsl"
#endif

layout(scalar, push_constant) uniform PushConstants { PlacePush push; };

const float kMostDistance = 4398046511104.0;  // 2^42

// A mantissa times 2^exponent, at most kMostDistance, or negative below 2^-100, unless it is 0.
float scaledDistance(float mantissa, int exponent) {
  if (mantissa <= 0.0) return mantissa;
  return exponent < -100 ? -1.0 : exponent > 42 ? kMostDistance : min(mantissa * twoTo(exponent), kMostDistance);
}

// Whether floats hold the sensor and its distances.
bool place(DeformedSensor d) {
  const MeshRecord mesh = meshes[d.mesh];
  const PlacedSensor placed =
      placedSensor(transformOf(sweeps[d.sensor].pose), mesh, d.mesh, push.anchor, push.anchorLow, true, d.slack);
  if (!placed.inRange) return false;
  Sensor sensor = sensors[d.sensor];
  sensor.placement = placed.placement;
  sensor.scale = twoTo(-placed.exponent);
  sensor.unscale = twoTo(placed.exponent);
  const int exponent = d.exponent - placed.exponent;
  sensor.distance = scaledDistance(d.way, exponent);
  if (sensor.distance < 0.0 || (d.perWay > 0.0 && exponent > 120)) return false;
  sensor.stopBefore = scaledDistance(d.stopBefore, exponent);
  if (d.clearance > 0.0) {
    // As in sensors.cpp: at most 2^29 sizes, and at least 2^-40 of the scene's extent.
    if (d.clearance > 536870912.0 * sensor.unscale ||
        d.clearance < 9.2e-13 * (2.0 * sensor.unscale + placed.farthest)) {
      return false;
    }
    const vec3 halfExtent = placed.halfExtent;
    const float usual = 2.00001e-6 * max(halfExtent.x, max(halfExtent.y, halfExtent.z));
    sensor.frame[0].w = d.clearance * sensor.scale;
    sensor.frame[2].w = min(d.tolerance, usual) * sensor.scale;
  }
  sensor.centre = placed.centre;
  // 2^-37 of the way, for the velocity that sensorBoxOf (contact/nodes.glsl) raises.
  sensor.halfExtent = 1.000001 * (placed.halfExtent + d.clearance + 7.3e-12 * (placed.farthest + d.clearance));
  sensors[d.sensor] = sensor;
  sweeps[d.sensor].scale = sensor.scale;
  sweeps[d.sensor].start = scaledDistance(d.certain, exponent);
  sweeps[d.sensor].stepPerUnit = d.perWay <= 0.0 ? d.perWay : d.perWay * twoTo(-exponent);
#ifndef RADAR_NO_DOUBLES
  sweeps[d.sensor].magnitude = magnitudeOf(sweeps[d.sensor].pose, mesh);
#endif
  states[d.sensor].hi = floatBitsToUint(sensor.distance);
  return true;
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i < push.count && !place(deformedSensors[i])) states[deformedSensors[i].sensor].flags |= kSearchOutOfRange;
}
