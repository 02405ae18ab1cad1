// Puts together the answers of searches past one object each: the first contact of a query, and its list of contacts, nearest
// first. A workgroup for each query chooses the searches that may be among those listed, sorts them in runs, and merges these
// two by two; of each it keeps as many as are listed.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "contact/interop.h"
#include "interop.h"
#include "radar/result.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kGatherGroup) in;

layout(scalar, binding = kSlotResults) restrict buffer Results { RadarResult results[]; };
layout(scalar, binding = kSlotGathered) readonly restrict buffer GatheredQueries { Gathered queries[]; };
// Numbers of a query's searches, in two lists, one of which is merged into the other.
layout(scalar, binding = kSlotOrder) coherent restrict buffer Order { uint order[]; };

layout(push_constant) uniform PushConstants { GatherPush push; };

shared uvec3 keys[kGatherGroup];
shared uint numbers[kGatherGroup];
shared uvec3 boundKey;  // of the last search that may be listed
shared uint boundNumber;
shared uint chosen;
shared uint missing;   // flags of the searches without an answer
shared uint detected;  // whether something certainly is in the way

Gathered g;
uint kept;  // of a run

// What orders the answers of a query, as engine/query/hits.cpp does: a decision; then those that are missing, which may
// hide an earlier contact; then t or, if that is open, lo. Non-negative doubles compare as their bits do.
uvec3 keyOf(uint search) {
  const uint i = g.first + search, status = results[i].status;
  if (status == RADAR_STATUS_invalid) return uvec3(1, 0, 0);
  if (status == RADAR_STATUS_undecided) return uvec3(2, results[i].lo.yx);
  const bool isDecision = status == RADAR_STATUS_hit && results[i].object == RADAR_NONE;
  return isDecision ? uvec3(0) : uvec3(2, results[i].t.yx);
}
const uvec3 kAfterAll = uvec3(3);  // with kNobody as its number

// Searches with equal keys keep their order.
bool precedes(uvec3 p, uint i, uvec3 q, uint j) {
  if (p.x != q.x) return p.x < q.x;
  if (p.y != q.y) return p.y < q.y;
  return p.z < q.z || (p.z == q.z && i < j);
}

// What this lane has written can be read by the others.
void finishStep() {
  memoryBarrierBuffer();
  barrier();
}

// Where a list has the first of a run that begins with this search.
uint placeOf(uint list, uint begin) { return list * push.searches + (g.first - push.first) + begin; }

// How many of the lanes' searches precede this lane's.
uint rankAmongLanes(uvec3 key, uint search) {
  keys[gl_LocalInvocationID.x] = key;
  numbers[gl_LocalInvocationID.x] = search;
  barrier();
  uint rank = 0;
  for (uint i = 0; i < kGatherGroup; ++i) rank += precedes(keys[i], numbers[i], key, search) ? 1 : 0;
  barrier();
  return rank;
}

// Lists the searches that come no later than the last of those listed can: each lane's first is one of that many.
void choose() {
  uvec3 key = kAfterAll;
  uint first = kNobody;
  for (uint i = gl_LocalInvocationID.x; i < g.count; i += kGatherGroup) {
    const uvec3 own = keyOf(i);
    if (own.x == 1) atomicOr(missing, results[g.first + i].flags);
    if (results[g.first + i].detected == RADAR_DETECTED_yes) detected = 1;
    if (!precedes(own, i, key, first)) continue;
    key = own;
    first = i;
  }
  if (rankAmongLanes(key, first) == kept - 1 && first != kNobody) {
    boundKey = key;
    boundNumber = first;
  }
  barrier();
  for (uint i = gl_LocalInvocationID.x; i < g.count; i += kGatherGroup) {
    if (!precedes(boundKey, boundNumber, keyOf(i), i)) order[placeOf(0, 0) + atomicAdd(chosen, 1)] = i;
  }
}

void sortRun(uint begin) {
  const uint at = begin + gl_LocalInvocationID.x;
  const bool has = at < chosen;
  const uint search = has ? order[placeOf(0, at)] : kNobody, rank = rankAmongLanes(has ? keyOf(search) : kAfterAll, search);
  if (has && rank < kept) order[placeOf(0, begin) + rank] = search;
}

// How many of a run, of up to `most`, precede a search that is not in it.
uint rankIn(uint list, uint begin, uint most, uint search) {
  const uvec3 key = keyOf(search);
  uint first = 0, end = begin < chosen ? min(most, chosen - begin) : 0;
  while (first < end) {
    const uint middle = (first + end) / 2, other = order[placeOf(list, begin) + middle];
    if (precedes(keyOf(other), other, key, search)) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  return first;
}

// Merges the runs of this many searches two by two, into the other list.
void mergeRuns(uint list, uint searches) {
  const uint runs = (chosen + searches - 1) / searches, each = min(kept, searches);
  for (uint i = gl_LocalInvocationID.x; i < runs * each; i += kGatherGroup) {
    const uint run = i / each, at = i % each, begin = run * searches;
    if (begin + at >= chosen) continue;
    const uint search = order[placeOf(list, begin) + at], rank = at + rankIn(list, (run ^ 1) * searches, each, search);
    if (rank < kept) order[placeOf(1 - list, (run & ~1u) * searches) + rank] = search;
  }
}

void main() {
  const uint query = workgroupIndex(), lane = gl_LocalInvocationID.x;
  if (query >= push.queries) return;
  g = queries[query];
  kept = max(g.listed, 1);
  if (lane == 0) {
    missing = detected = chosen = 0;
    boundKey = kAfterAll;
    boundNumber = kNobody;
  }
  barrier();
  choose();
  finishStep();
  for (uint begin = 0; begin < chosen; begin += kGatherGroup) sortRun(begin);
  finishStep();
  uint list = 0;
  for (uint searches = kGatherGroup; searches < chosen; searches *= 2) {
    mergeRuns(list, searches);
    list = 1 - list;
    finishStep();
  }
  const uint sorted = placeOf(list, 0);
  for (uint i = lane; i < g.listed; i += kGatherGroup) results[g.list + i] = results[g.first + order[sorted + i]];
  if (lane != 0) return;
  RadarResult answer = results[g.first + order[sorted]];
  if (answer.status == RADAR_STATUS_invalid) answer.flags = missing;
  if (answer.status == RADAR_STATUS_undecided && detected != 0) answer.detected = RADAR_DETECTED_yes;
  results[g.query] = answer;
}
