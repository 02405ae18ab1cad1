// States the searches for the queries that a host's shader has written, one invocation per query, as engine/contact/search_plan.cpp
// does (docs/method.md, "A host's geometry").
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "contact/interop.h"
#include "interop.h"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotStated) writeonly restrict buffer Stated { StatedSearch stated[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotSweeps) writeonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotExcluded) writeonly restrict buffer Excluded { uint excluded[]; };
#include "byte_load.glsl"
#include "shared/transform.glsl"
#include "load_transform.glsl"
#include "direction.glsl"
#include "shared/workgroup.glsl"

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
  return HostQuery(transformAt(byte, MatrixLayout(16, 4)), loadWords(byte + kQueryDirection),
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

void writeSweep(uint i, HostQuery q, int directionExponent) {
  Sweep sweep;
  sweep.pose = preciseRows(q.pose);
  sweep.anyHit = q.flags & kQueryAnyHit;
  sweep.result = i;
  sweep.scale = sweep.start = 0.0;
  sweep.ignoreLeaving = sweep.isMirrored = sweep.cpuDecides = 0;
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
  sweep.directionLength = sweep.perParameter = -1.0LF;
  sweep.drift = double[3](0.0LF, 0.0LF, 0.0LF);
  sweep.slack = sweep.magnitude = 0.0LF;
  sweep.distance = packDouble2x32(distance);
#endif
  sweeps[i] = sweep;
}

StatedSearch statedFor(uint i, HostQuery q) {
  StatedSearch s;
  s.flags = !isValid(q) ? kSearchNoQuery : push.inRange == 0 ? kSearchOutOfRange : 0;
  if (s.flags != 0) return s;
  s.clearance = s.slackShare = s.tolerance = s.slack = s.perWay = 0.0;
  const uint significand = q.distance >= 0x800000u ? q.distance : q.distance << (23 - findMSB(q.distance));
  const bool moves = (q.distance & 0x7fffffffu) != 0;
  s.exponent = moves ? exponentOf(q.distance) : 0;
  s.way = s.certain = moves ? uintBitsToFloat(0x3f800000u | (significand & 0x7fffffu)) : 0.0;
  s.stopBefore = (q.flags & kQueryAnyHit) != 0 ? s.way : -1.0;
  s.mesh = q.mesh;
  s.mask = q.mask;
  s.firstExcluded = i;
  s.endExcluded = q.exclude == kNobody ? i : i + 1;
  s.start = push.start;
  excluded[i] = q.exclude;
  writeSweep(i, q, exponentOf(q.direction));
  return s;
}

void main() {
  const uint i = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (i >= push.queries) return;
  const uint count = push.countByte == kNobody ? push.queries : min(loadWord(push.countByte), push.queries);
  if (i == 0) counts.queries = count;
  StatedSearch s;
  s.flags = kSearchNoQuery;
  if (i < count) s = statedFor(i, queryAt(i * push.stride));
  if (s.flags != 0) sweeps[i].result = i;
  stated[i] = s;
}
