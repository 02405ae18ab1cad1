// Encodes the queries that a host's shader has written for the search, one invocation per query, as engine/contact/sensors.cpp
// does (docs/method.md, "A host's geometry").
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "contact/interop.h"
#include "interop.h"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotSensors) writeonly restrict buffer Sensors { Sensor sensors[]; };
layout(scalar, binding = kSlotStates) writeonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotTasks) writeonly restrict buffer Tasks { SearchTask tasks[]; };
layout(scalar, binding = kSlotSweeps) writeonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotExcluded) writeonly restrict buffer Excluded { uint excluded[]; };
#include "byte_load.glsl"
#include "transform.glsl"
#include "load_transform.glsl"
#include "placement.glsl"
#include "direction.glsl"
#include "shared/workgroup.glsl"
#include "world.glsl"
#include "sensor.glsl"

layout(scalar, push_constant) uniform PushConstants { PlanPush push; };

struct HostQuery {
  Transform pose;
  uvec3 direction;  // bits
  uint distance;
  uint mesh;
  uint mask;
  uint exclude;
  uint flags;
};

HostQuery queryAt(uint byte) {
  return HostQuery(transformAt(byte, TransformLayout(16, 4)), loadWords(byte + kQueryDirection),
                   loadWord(byte + kQueryDistance), loadWord(byte + kQueryMesh), loadWord(byte + kQueryMask),
                   loadWord(byte + kQueryExclude), loadWord(byte + kQueryFlags));
}

// As radar::validate for a Query. A removed mesh has a unit of 0.
bool isValid(HostQuery q) {
  const bool isMesh = q.mesh < push.meshes && floatBitsToUint(meshes[min(q.mesh, push.meshes - 1)].unit) != 0;
  const bool isDirection = isFinite(q.direction.x) && isFinite(q.direction.y) && isFinite(q.direction.z) &&
                           ((q.direction.x | q.direction.y | q.direction.z) & 0x7fffffffu) != 0;
  const bool isDistance = isFinite(q.distance) && (q.distance <= 0x80000000u);
  return isMesh && q.pose.isFinite && isDirection && isDistance && (q.flags & ~kQueryAnyHit) == 0;
}

// The distance over 2^exponent, exactly, or the limits of engine/contact/sensors.cpp: at most 2^42; negative below 2^-100.
float scaledDistance(uint distance, int exponent) {
  if ((distance & 0x7fffffffu) == 0) return 0.0;
  const int e = exponentOf(distance) - exponent;
  if (e >= 42) return 4398046511104.0;
  const uint significand = distance >= 0x800000u ? distance : distance << (23 - findMSB(distance));
  return e < -100 ? -1.0 : uintBitsToFloat(uint(e + 127) << 23 | (significand & 0x7fffffu));
}

#ifndef RADAR_NO_DOUBLES
#include "contact/root.glsl"
// The length, rounded to nearest, by the steps of exact::length; 0 where that needs exact arithmetic.
double lengthOf(dvec3 d) {
  const DoubleDouble square = plus(plus(product(d.x, d.x), product(d.y, d.y)), product(d.z, d.z));
  const double root = rootOf(square.high);
  precise double rest = quotient(minus(square, product(root, root)).high, 2.0LF * root);
  precise double error = 9.094947017729282e-13LF * abs(rest) + 8.077935669463161e-28LF * root;  // 2^-40, 2^-90
  precise double below = root + (rest - error), above = root + (rest + error);
  return below == above ? below : 0.0LF;
}
#endif

void writeSweep(uint i, HostQuery q, int directionExponent, Sensor sensor) {
  Sweep sweep;
  sweep.pose = preciseRows(q.pose);
  sweep.anyHit = q.flags & kQueryAnyHit;
  sweep.result = i;
  sweep.scale = sensor.scale;
  sweep.start = sensor.distance;
  sweep.ignoreLeaving = sweep.isMirrored = sweep.hasClearance = 0;
  sweep.stepPerUnit = 0.0;
  const uvec2 x = scaledBits(q.direction.x, directionExponent), y = scaledBits(q.direction.y, directionExponent),
              z = scaledBits(q.direction.z, directionExponent), distance = doubleBits(q.distance);
#ifdef RADAR_NO_DOUBLES
  sweep.direction = uvec2[3](x, y, z);
  sweep.directionLength = sweep.perParameter = sweep.slack = sweep.magnitude = uvec2(0);
  sweep.drift = uvec2[3](uvec2(0), uvec2(0), uvec2(0));
  sweep.distance = distance;
#else
  const dvec3 d = dvec3(packDouble2x32(x), packDouble2x32(y), packDouble2x32(z));
  sweep.direction = double[3](d.x, d.y, d.z);
  sweep.directionLength = sweep.perParameter = lengthOf(d);
  sweep.drift = double[3](0.0LF, 0.0LF, 0.0LF);
  sweep.hasClearance = sweep.directionLength == 0.0LF ? 1 : 0;
  sweep.slack = sweep.magnitude = 0.0LF;
  sweep.distance = packDouble2x32(distance);
#endif
  sweeps[i] = sweep;
}

// Returns SearchState::flags. `hi`: SearchState::hi.
uint plan(uint i, HostQuery q, out uint hi) {
  hi = 0;
  if (!isValid(q)) return kSearchNoQuery;
  const MeshRecord mesh = meshes[q.mesh];
  if (push.inRange == 0) return kSearchOutOfRange;
  const PlacedSensor placed = placedSensor(q.pose, mesh, q.mesh, push.anchor, push.anchorLow, push.start != kNobody, 0.0);
  if (!placed.inRange) return kSearchOutOfRange;
  Sensor sensor;
  sensor.placement = placed.placement;
  const int exponent = placed.exponent, directionExponent = exponentOf(q.direction);
  sensor.scale = twoTo(-exponent);
  sensor.unscale = twoTo(exponent);
  sensor.distance = scaledDistance(q.distance, exponent);
  if (sensor.distance < 0.0) return kSearchOutOfRange;
  sensor.stopBefore = (q.flags & kQueryAnyHit) != 0 ? sensor.distance : -1.0;
  const vec3[3] axes = axesAlong(q.direction, directionExponent);
  for (uint row = 0; row < 3; ++row) sensor.frame[row] = vec4(axes[row], 0.0);
  sensor.direction = axes[2];
  sensor.centre = placed.centre;
  sensor.halfExtent = placed.halfExtent + 3e-8 * placed.farthest;  // 2^-25 of the way, for the direction
  sensor.mask = q.mask;
  sensor.firstExcluded = i;
  sensor.endExcluded = q.exclude == kNobody ? i : i + 1;
  excluded[i] = q.exclude;
  sensors[i] = sensor;
  writeSweep(i, q, directionExponent, sensor);
  hi = floatBitsToUint(sensor.distance);
  return 0;
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.queries) return;
  const uint count = push.countByte == kNobody ? push.queries : min(loadWord(push.countByte), push.queries);
  if (i == 0) counts.queries = count;
  uint hi = 0, flags = kSearchNoQuery;
  if (i < count) flags = plan(i, queryAt(i * push.stride), hi);
  states[i] = SearchState(hi, flags, kNobody);
  if (flags != 0) {
    sweeps[i].result = i;
  } else if (push.start != kNobody) {
    tasks[atomicAdd(counts.rounds[0].tasks, 1)] = SearchTask(i, kNobody, kNobody, push.start, 0.0);
  }
}
