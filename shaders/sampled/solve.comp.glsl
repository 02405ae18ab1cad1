// Solves the proposed pairs: one workgroup per sensor, one invocation per distinct pair. Candidates are taken kRound at a
// time, best first, until a round has a pair that certainly meets within D. With RADAR_NO_DOUBLES, for devices without
// doubles, all pairs are unresolved.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "interop.h"
#include "shared/triangle_pair_bounds.glsl"
#include "shared/scene.glsl"

#ifndef RADAR_NO_DOUBLES
#include "shared/widen.glsl"
#endif

layout(local_size_x = kRound) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kSlotDraws) readonly restrict buffer Draws { Draw draws[]; };
layout(scalar, binding = kSlotItems) readonly restrict buffer Items { Item items[]; };
layout(scalar, binding = kSlotCandidates) readonly restrict buffer Candidates { Candidate candidates[]; };
layout(scalar, binding = kSlotAnswers) restrict buffer Answers { Answer answers[]; };
layout(scalar, binding = kSlotSampledUnresolved) writeonly restrict buffer SampledUnresolvedPairs { SampledUnresolved unresolvedPairs[]; };

shared uvec2 named[kRound];     // (itemB, itemA) of the round's candidates
shared uvec2 pairs[kRound];     // the distinct ones
shared uint pairCount;
shared uvec4 pairIds[kRound];   // object, triB, triA, feature or kNobody
shared bool isUnresolved[kRound];

#ifndef RADAR_NO_DOUBLES
// 2^-21. A pair counts as solved if its t is late by at most this times max(sensor's size, t).
const double kTolerance = 4.76837158203125e-7LF;

shared double pairHi[kRound];
shared double pairLow[kRound];

dvec3 placed(PreciseRows pose, uint vertex) {
  const dvec3 p = widened(vertexBitsAt(vertex));
  dvec3 world;
  for (int k = 0; k < 3; ++k) {
    precise double sum = ((pose[k].x * p.x + pose[k].y * p.y) + pose[k].z * p.z) + pose[k].w;
    world[k] = sum;
  }
  return world;
}

void corners(PreciseRows pose, uint slot, out dvec3 p[3]) {
  const uvec4 corner = triangleAt(slot);
  for (uint i = 0; i < 3; ++i) p[i] = placed(pose, corner[i]);
}

bool better(uint x, uint y) {
  if (pairHi[x] != pairHi[y]) return pairHi[x] < pairHi[y];
  if (pairIds[x].x != pairIds[y].x) return pairIds[x].x < pairIds[y].x;
  if (pairIds[x].y != pairIds[y].y) return pairIds[x].y < pairIds[y].y;
  return pairIds[x].z < pairIds[y].z;
}

// Returns the feature that attains `pairHi`, if the pair certainly meets within D, else kNobody.
uint solve(uint v, uint lane, uint object, uint slotA, uint slotB) {
  dvec3 a[3], b[3];
  corners(views[v].pose, slotA, a);
  corners(objects[object].pose, slotB, b);
  const dvec3 direction = dvec3(views[v].direction[0], views[v].direction[1], views[v].direction[2]);
  const double length = views[v].directionLength;
  const Impact meeting = impactOf(a, b, direction);
  // Contact fills one interval, and a feature certainly meets at or after the start, so the pair certainly meets by `s`.
  // It is solved if no feature that may count comes earlier by more than the tolerance. Features without a parameter are
  // bounded by the extents of their parts.
  const double s = max(lastOf(meeting), 0.0LF);
  const double tolerance = kTolerance * max(quotient(views[v].size, length), s);
  const double earliest = max(min(firstOf(meeting), meeting.unknown), 0.0LF);
  const bool meets = meeting.ahead && s - earliest <= tolerance;
  const double hi = s * length * (1.0LF + 8.881784197001252e-16LF);
  pairHi[lane] = hi;
  const double low = earliest * length * (1.0LF - 8.881784197001252e-16LF);
  pairLow[lane] = low;
  isUnresolved[lane] = !meets && !meeting.isOver && low <= views[v].distance;
  return meets && hi <= views[v].distance ? meeting.feature : kNobody;
}

void writeWinner(uint v, uint winner) {
  answers[v].hi = pairHi[winner];
  answers[v].object = pairIds[winner].x;
  answers[v].triB = pairIds[winner].y;
  answers[v].triA = pairIds[winner].z;
  answers[v].feature = pairIds[winner].w;
}

SampledUnresolved unresolvedPair(uint i) { return SampledUnresolved(pairLow[i], pairIds[i].x, pairIds[i].y, pairIds[i].z, 0); }
#else
bool better(uint x, uint y) { return false; }

uint solve(uint v, uint lane, uint object, uint slotA, uint slotB) {
  isUnresolved[lane] = true;
  return kNobody;
}

void writeWinner(uint v, uint winner) {}

SampledUnresolved unresolvedPair(uint i) { return SampledUnresolved(double(0), pairIds[i].x, pairIds[i].y, pairIds[i].z, 0); }
#endif

void solvePair(uint v, uint lane) {
  const Item itemB = items[pairs[lane].x / kItemTriangles], itemA = items[pairs[lane].y / kItemTriangles];
  const uint object = draws[itemB.draw].object;
  const uint slotB = meshes[objects[object].mesh].firstTriangle + itemB.firstTriangle + pairs[lane].x % kItemTriangles;
  const uint slotA = meshes[views[v].mesh].firstTriangle + itemA.firstTriangle + pairs[lane].y % kItemTriangles;
  pairIds[lane] = uvec4(object, triangleAt(slotB).w, triangleAt(slotA).w, solve(v, lane, object, slotA, slotB));
}

void main() {
  const uint v = gl_WorkGroupID.x;
  const uint lane = gl_LocalInvocationID.x;
  const uint count = answers[v].candidates;
  uint solved = 0, unresolved = 0;
  uint winner = kNobody;
  for (uint first = 0; first < count && winner == kNobody; first += kRound) {
    const bool inRound = first + lane < count;
    named[lane] = inRound ? uvec2(candidates[kCells * v + first + lane].itemB, candidates[kCells * v + first + lane].itemA)
                          : uvec2(kNobody);
    barrier();
    if (lane == 0) {
      uint distinct = 0;
      for (uint i = 0; i < kRound; ++i) {
        bool fresh = named[i].x != kNobody && named[i].y != kNobody;
        for (uint j = 0; j < distinct && fresh; ++j) fresh = pairs[j] != named[i];
        if (fresh) pairs[distinct++] = named[i];
      }
      pairCount = distinct;
    }
    barrier();
    if (lane < pairCount) solvePair(v, lane);
    barrier();
    for (uint i = 0; i < pairCount; ++i) {
      if (pairIds[i].w != kNobody && (winner == kNobody || better(i, winner))) winner = i;
    }
    solved += pairCount;
    for (uint i = 0; i < pairCount && unresolved < kUnresolvedPerView; ++i) {
      if (!isUnresolved[i]) continue;
      if (lane == 0) unresolvedPairs[kUnresolvedPerView * v + unresolved] = unresolvedPair(i);
      ++unresolved;
    }
    if (lane == 0 && winner != kNobody) writeWinner(v, winner);
    barrier();
  }
  if (lane == 0) {
    answers[v].pairs = solved;
    answers[v].unresolvedPairs = unresolved;
  }
}
