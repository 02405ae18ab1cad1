// Makes of stated searches what the search reads, one invocation per search: scales them, and places their sensors with room for
// every rounding (docs/method.md, "Placement on the device"). Only the device knows where a host has put vertices and objects.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_null_initializer : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "shared/transform.glsl"
#include "shared/placement.glsl"
#include "shared/workgroup.glsl"
#include "frame.glsl"
#ifndef RADAR_NO_DOUBLES
#include "magnitude.glsl"
#endif

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotStated) readonly restrict buffer Stated { StatedSearch stated[]; };
layout(scalar, binding = kSlotSensors) writeonly restrict buffer Sensors { Sensor sensors[]; };
layout(scalar, binding = kSlotStates) writeonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotTasks) writeonly restrict buffer Tasks { SearchTask tasks[]; };
layout(scalar, binding = kSlotSweeps) restrict buffer Sweeps { Sweep sweeps[]; };
// The root of the tree over objects has the box of all, about its anchor. A host that moves some has its own link there.
layout(binding = kSlotObjectNodes) uniform utextureBuffer objectNodeTexels;

layout(scalar, push_constant) uniform PushConstants { EncodePush push; };

const float kMostCoordinate = 1.2e24;  // 2^80
// Scaled. Longer distances are clipped to this, 2^42: contacts are nearer, by kLeastShare.
const float kMostDistance = 4398046511104.0;
// Scaled. Shorter distances, other than 0, are out of range: floats might flush them to 0, which would make contact before D
// indistinguishable from contact at D.
const int kLeastExponent = -100;
// A sensor smaller than this share of the scene's extent, 2^-38, is scaled to less than 1, so that distances stay below 2^40.
const float kLeastShare = 3.64e-12;
// Clearances below this share of the scene's extent, 2^-40, are left to the CPU, whose doubles may be unable to tell them from 0.
const float kLeastClearance = 9.2e-13;
// Of the axes' components, beyond their rounding: 2^-25.
const float kAxisError = 3e-8;

// Whether floats hold the placed mesh's coordinates, and their terms.
bool holdsTerms(Transform t, MeshRecord mesh) {
  const vec3 most = abs(mesh.origin) + max(abs(mesh.lo), abs(mesh.hi));
  bool holds = all(lessThanEqual(abs(mesh.origin), vec3(kMostCoordinate)));
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    holds = holds && dot(abs(m.xyz), most) + abs(m.w) <= kMostCoordinate;
  }
  return holds;
}

// Distance from a point, given about the anchor, to the farthest point of the objects, as a sum over the axes.
float farthestFrom(vec3 centre) {
  const vec3 middle = uintBitsToFloat(texelFetch(objectNodeTexels, 0).xyz),
             halfExtent = uintBitsToFloat(texelFetch(objectNodeTexels, 1).xyz);
  const vec3 far = abs(middle - centre) + halfExtent;
  return 1.00001 * (far.x + far.y + far.z);
}

// A mantissa times 2^exponent, at most kMostDistance, or negative if that is too short.
float scaledDistance(float mantissa, int exponent) {
  if (mantissa <= 0.0) return mantissa;
  return exponent < kLeastExponent ? -1.0 : exponent > 42 ? kMostDistance : min(mantissa * twoTo(exponent), kMostDistance);
}

uvec2[3] directionOf(uint i) {
#ifdef RADAR_NO_DOUBLES
  return sweeps[i].direction;
#else
  return uvec2[3](unpackDouble2x32(sweeps[i].direction[0]), unpackDouble2x32(sweeps[i].direction[1]),
                  unpackDouble2x32(sweeps[i].direction[2]));
#endif
}

// Returns SearchState::flags; if they are 0, writes the sensor. `hi`: SearchState::hi.
uint encode(uint i, StatedSearch s, out uint hi) {
  hi = 0;
  const MeshRecord mesh = meshes[s.mesh];
  const Transform t = transformOf(sweeps[i].pose);
  if (!fitsFloats(t, mesh) || !holdsTerms(t, mesh)) return kSearchOutOfRange;
  const Position position = positionOf(t, mesh.origin);
  Sensor sensor;
  sensor.placement = placementOf(mesh, t, position);
  sensor.placement.error = 1.000001 * (sensor.placement.error + s.slack);
  sensor.placement.mask = 0;
  sensor.placement.mesh = s.mesh;
  const PlacedBox box = boxOf(t, mesh, position, push.anchor, push.anchorLow);
  const float farthest = s.start == kNobody ? 0.0 : farthestFrom(box.centre);
  // A point with a clearance is as large as its ball.
  const float size = max(max(sensor.placement.size, s.clearance), kLeastShare * farthest);
  if (sensor.placement.perUnit <= 0.0 || size < 1.0 / kMostCoordinate || farthest > 8.0 * kMostCoordinate ||
      s.clearance > kMostCoordinate) {
    return kSearchOutOfRange;
  }
  const int sizeExponent = int(floatBitsToUint(size) >> 23) - 127, exponent = s.exponent - sizeExponent;
  sensor.scale = twoTo(-sizeExponent);
  sensor.unscale = twoTo(sizeExponent);
  sensor.distance = scaledDistance(s.way, exponent);
  sensor.stopBefore = scaledDistance(s.stopBefore, exponent);
  if (sensor.distance < 0.0 || (s.perWay > 0.0 && exponent > 120)) return kSearchOutOfRange;
  if (s.clearance > 0.0 && s.clearance < kLeastClearance * (2.0 * sensor.unscale + farthest)) return kSearchOutOfRange;
  const float side = 2.0 * max(box.halfExtent.x, max(box.halfExtent.y, box.halfExtent.z));
  const float tolerance = min(s.tolerance, 1.00001e-6 * max(side, s.clearance));
  const vec3[3] axes = axesAlong(directionOf(i));
  sensor.across = axes[0];
  sensor.clearance = s.clearance * sensor.scale;
  sensor.upwards = axes[1];
  sensor.slackShare = s.slackShare;
  sensor.along = sensor.direction = axes[2];
  sensor.tolerance = tolerance * sensor.scale;
  sensor.centre = box.centre;
  // 2^-44 of what is placed far away.
  const vec3 halfExtent = 1.000001 * (box.halfExtent + s.slack) + 5.7e-14 * (abs(position.high) + abs(push.anchor)) + box.flushed;
  // 2^-37 of the way, for the velocity that sensorBoxOf (nodes.glsl) raises.
  const float way = farthest + s.clearance;
  sensor.halfExtent = 1.000001 * (halfExtent + s.clearance + 7.3e-12 * way) + kAxisError * way;
  sensor.mask = s.mask;
  sensor.firstExcluded = s.firstExcluded;
  sensor.endExcluded = s.endExcluded;
  sensors[i] = sensor;
  sweeps[i].scale = sensor.scale;
  sweeps[i].start = scaledDistance(s.certain, exponent);
  sweeps[i].stepPerUnit = s.perWay <= 0.0 ? s.perWay : s.perWay * twoTo(-exponent);
#ifndef RADAR_NO_DOUBLES
  if (sweeps[i].directionLength < 0.0LF) {
    const double length = lengthOf(dvec3(sweeps[i].direction[0], sweeps[i].direction[1], sweeps[i].direction[2]));
    sweeps[i].directionLength = length;
    if (sweeps[i].perParameter < 0.0LF) sweeps[i].perParameter = length;
    if (length == 0.0LF) sweeps[i].cpuDecides = 1;
  }
  if (sweeps[i].magnitude < 0.0LF) sweeps[i].magnitude = magnitudeOf(sweeps[i].pose, mesh);
#endif
  hi = floatBitsToUint(sensor.distance);
  return 0;
}

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const StatedSearch s = stated[i];
  uint hi = 0, flags = s.flags;
  if (flags == 0) flags = encode(i, s, hi);
  if (flags != 0) {
    // Lanes without a search read the first sensor, whatever it is.
    const Sensor none = {};
    sensors[i] = none;
  }
  states[i] = SearchState(hi, flags, kNobody);
  if (flags == 0 && s.start != kNobody) {
    const uint start = s.start == kWholeTree ? texelFetch(objectNodeTexels, 0).w : s.start;
    tasks[atomicAdd(counts.rounds[0].tasks, 1)] = SearchTask(i, kNobody, kNobody, start, 0.0);
  }
}
