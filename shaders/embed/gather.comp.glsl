// Puts together the answers of searches past one object each: the first contact of a query, and its list of contacts, nearest
// first. One invocation per search.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "interop.h"
#include "radar/result.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kHostGroup) in;

layout(scalar, binding = kSlotResults) restrict buffer Results { RadarResult results[]; };
layout(scalar, binding = kSlotGathered) readonly restrict buffer GatheredSearches { Gathered searches[]; };

layout(push_constant) uniform PushConstants { GatherPush push; };

// What orders the answers of a query, as engine/query/hits.cpp does: a decision; then those that are missing, which may
// hide an earlier contact; then t or, if that is open, lo. Non-negative doubles compare as their bits do.
uvec3 keyOf(uint i) {
  const uint status = results[i].status;
  if (status == RADAR_STATUS_invalid) return uvec3(1, 0, 0);
  if (status == RADAR_STATUS_undecided) return uvec3(2, results[i].lo.yx);
  const bool isDecision = status == RADAR_STATUS_hit && results[i].object == RADAR_NONE;
  return isDecision ? uvec3(0) : uvec3(2, results[i].t.yx);
}
bool isLess(uvec3 p, uvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

void main() {
  const uint search = workgroupIndex() * kHostGroup + gl_LocalInvocationID.x;
  if (search >= push.count) return;
  const Gathered g = searches[search];
  const uint own = push.first + search;
  const uvec3 key = keyOf(own);
  uint rank = 0, missing = 0;
  bool detected = false;
  for (uint i = g.first; i < g.first + g.count; ++i) {
    const uvec3 other = keyOf(i);
    if (isLess(other, key) || (other == key && i < own)) ++rank;
    if (other.x == 1) missing |= results[i].flags;
    detected = detected || results[i].detected == RADAR_DETECTED_yes;
  }
  RadarResult answer = results[own];
  if (rank < g.listed) results[g.list + rank] = answer;
  if (rank != 0) return;
  if (answer.status == RADAR_STATUS_invalid) answer.flags = missing;
  if (answer.status == RADAR_STATUS_undecided && detected) answer.detected = RADAR_DETECTED_yes;
  results[g.query] = answer;
}
