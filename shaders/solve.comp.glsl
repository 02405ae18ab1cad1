// Solves the nominated pairs: a workgroup per sensor, an invocation per distinct pair. Candidates are taken kRound at a
// time, best first, until a round has a pair that certainly meets within D.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "contact.glsl"

layout(local_size_x = kRound) in;

layout(scalar, binding = kBindOriginals) readonly restrict buffer Originals { vec3 originals[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uint indices[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kBindViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kBindDraws) readonly restrict buffer Draws { Draw draws[]; };
layout(scalar, binding = kBindItems) readonly restrict buffer Items { Item items[]; };
layout(scalar, binding = kBindCandidates) readonly restrict buffer Candidates { Candidate candidates[]; };
layout(scalar, binding = kBindAnswers) restrict buffer Answers { Answer answers[]; };

shared uvec2 named[kRound];    // (itemB, itemA) of the round's candidates
shared uvec2 pairs[kRound];    // the distinct ones
shared uint pairCount;
shared double pairHi[kRound];
shared uvec4 pairIds[kRound];  // object, triB, triA, feature

dvec3 placed(double pose[12], uint vertex) {
  const dvec3 p = dvec3(originals[vertex]);
  dvec3 world;
  for (int k = 0; k < 3; ++k) {
    precise double sum = ((pose[4 * k] * p.x + pose[4 * k + 1] * p.y) + pose[4 * k + 2] * p.z) + pose[4 * k + 3];
    world[k] = sum;
  }
  return world;
}

void corners(double pose[12], uint mesh, uint triangle, out dvec3 p[3]) {
  const MeshRecord record = meshes[mesh];
  for (uint i = 0; i < 3; ++i) p[i] = placed(pose, record.firstVertex + indices[record.firstIndex + 3 * triangle + i]);
}

bool before(uint x, uint y) {
  if (pairHi[x] != pairHi[y]) return pairHi[x] < pairHi[y];
  if (pairIds[x].x != pairIds[y].x) return pairIds[x].x < pairIds[y].x;
  if (pairIds[x].y != pairIds[y].y) return pairIds[x].y < pairIds[y].y;
  return pairIds[x].z < pairIds[y].z;
}

void solvePair(uint v, uint lane) {
  const Item itemB = items[pairs[lane].x / kItemTriangles], itemA = items[pairs[lane].y / kItemTriangles];
  const uint triB = itemB.firstTriangle + pairs[lane].x % kItemTriangles;
  const uint triA = itemA.firstTriangle + pairs[lane].y % kItemTriangles;
  const uint object = draws[itemB.draw].object;
  dvec3 a[3], b[3];
  corners(views[v].pose, views[v].mesh, triA, a);
  corners(objects[object].pose, objects[object].mesh, triB, b);
  const dvec3 direction = dvec3(views[v].direction[0], views[v].direction[1], views[v].direction[2]);
  const double length = views[v].directionLength;
  const Contact contact = firstContact(a, b, direction, views[v].size / length);
  const double hi = contact.s * length * (1.0LF + 8.881784197001252e-16LF);
  pairHi[lane] = hi;
  pairIds[lane] = uvec4(object, triB, triA, contact.meets && hi <= views[v].distance ? contact.feature : kNobody);
}

void main() {
  const uint v = gl_WorkGroupID.x;
  const uint lane = gl_LocalInvocationID.x;
  const uint count = answers[v].candidates;
  uint solved = 0;
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
      if (pairIds[i].w != kNobody && (winner == kNobody || before(i, winner))) winner = i;
    }
    solved += pairCount;
    if (lane == 0 && winner != kNobody) {
      answers[v].hi = pairHi[winner];
      answers[v].object = pairIds[winner].x;
      answers[v].triB = pairIds[winner].y;
      answers[v].triA = pairIds[winner].z;
      answers[v].feature = pairIds[winner].w;
    }
    barrier();
  }
  if (lane == 0) answers[v].pairs = solved;
}
