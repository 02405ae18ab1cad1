// Proposes pairs of triangles to be solved: one workgroup per sensor, which takes the first kPairsPerView distinct pairs of its
// candidates. All are left to refine.comp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"

layout(local_size_x = kPairsPerView) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotDraws) readonly restrict buffer Draws { Draw draws[]; };
layout(scalar, binding = kSlotItems) readonly restrict buffer Items { Item items[]; };
layout(scalar, binding = kSlotCandidates) readonly restrict buffer Candidates { Candidate candidates[]; };
layout(scalar, binding = kSlotAnswers) readonly restrict buffer Answers { Answer answers[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) writeonly restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };

shared uvec2 pairs[kPairsPerView];   // (itemB, itemA) of the distinct ones so far
shared uvec2 named[kPairsPerView];   // those of the candidates at hand
shared uint isNew[kPairsPerView];
shared uint firstPair;

uint slotOf(uint name) {
  const Item item = items[name / kItemTriangles];
  return meshes[draws[item.draw].mesh].firstTriangle + item.firstTriangle + name % kItemTriangles;
}

void main() {
  const uint v = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
  const uint count = answers[v].candidates;
  uint distinct = 0;
  for (uint first = 0; first < count && distinct < kPairsPerView; first += kPairsPerView) {
    const uint at = kCells * v + first + lane;
    const uvec2 name = first + lane < count ? uvec2(candidates[at].itemB, candidates[at].itemA) : uvec2(kNobody);
    named[lane] = name;
    barrier();
    // A candidate without a triangle on either side proposes none.
    bool fresh = name.x != kNobody && name.y != kNobody;
    for (uint k = 0; k < distinct; ++k) fresh = fresh && pairs[k] != name;
    const uint ofRound = min(count - first, kPairsPerView);
    for (uint k = 0; k < ofRound; ++k) fresh = fresh && (k >= lane || named[k] != name);
    isNew[lane] = uint(fresh);
    barrier();
    uint place = distinct, end = distinct;
    for (uint k = 0; k < ofRound; ++k) {
      place += k < lane ? isNew[k] : 0;
      end += isNew[k];
    }
    if (fresh && place < kPairsPerView) pairs[place] = name;
    distinct = min(end, kPairsPerView);
    barrier();
  }
  if (distinct == 0) return;
  if (lane == 0) {
    firstPair = atomicAdd(counts.refinedPairs, distinct);
    atomicAdd(counts.leftPairs, distinct);
    const uint groups = (firstPair + distinct + kContactGroup - 1) / kContactGroup;
    atomicMax(counts.refineGroups[0], min(groups, kMostWorkgroups));
    atomicMax(counts.refineGroups[1], (groups - 1) / kMostWorkgroups + 1);
  }
  barrier();
  if (lane >= distinct) return;
  const uint i = firstPair + lane;
  const Item other = items[pairs[lane].x / kItemTriangles];
  refinedPairs[i] = RefinedPair(uvec2(0), uvec2(0), uvec2(0), v, draws[other.draw].object, slotOf(pairs[lane].y),
                                slotOf(pairs[lane].x), 0, kNobody, 0.0, 0, i, kFeatures);
}
