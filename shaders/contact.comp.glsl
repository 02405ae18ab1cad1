// The search for a sensor's first contact: one subgroup per sensor goes through its cluster pairs, nearest first, in rounds
// of 16, 64, 256, ... until the next is farther than what is known to be touched. Within a pair of clusters both sides are
// trimmed against the other's box, triangle pairs pass a box test and separating axes, and what is left is solved in float;
// what may then still be first is solved in double precision. With RADAR_NO_DOUBLES, on a device without, that is left to
// the host.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "contact.glsl"

// The subgroup's size: with one subgroup a workgroup, no lane waits for another's work.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;

layout(scalar, binding = kBindPositions) readonly restrict buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindOriginals) readonly restrict buffer Originals { vec3 originals[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uvec3 triangles[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kBindNodes) readonly restrict buffer Nodes { ClusterRecord nodes[]; };
layout(scalar, binding = kBindTargets) readonly restrict buffer Targets { Target targets[]; };
layout(scalar, binding = kBindPlacements) readonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kBindRefs) readonly restrict buffer Refs { ClusterRef refs[]; };
layout(scalar, binding = kBindBoxes) readonly restrict buffer Boxes { RefBox boxes[]; };
layout(scalar, binding = kBindClusterPairs) restrict buffer ClusterPairs { ClusterPair pairs[]; };
layout(scalar, binding = kBindStates) restrict buffer States { State states[]; };
layout(scalar, binding = kBindContenders) restrict buffer Contenders { Contender contenders[]; };
layout(scalar, binding = kBindTiles) readonly restrict buffer Tiles { uvec2 tiles[]; };

#include "contender.glsl"

layout(push_constant) uniform Push { uint count; uint groupsX; } push;

const uint kBuckets = 32;
const uint kFirstRound = 16;
// Lavapipe ends loops silently after 65,535 iterations in one invocation, nested ones included. So the search counts them,
// as if the compiler unrolled none, stops well before, and the next dispatch goes on: after kWorkPerDispatch at most one
// round's scan and one pair of clusters follow, 4,096 solves, which with 8 lanes are 34,000.
const uint kWorkPerDispatch = 20000;
const uint kTrimWork = 5;    // a triangle: 3 copies
const uint kSolveWork = 40;  // two triangles: 3 corners, 3 rows each, 3 steps of sorting
// Cluster pairs are taken in runs of so many, nearest first within a run, so that going through them once leaves room for
// work; what a run has found cuts the next one short.
layout(constant_id = 1) const uint kRun = 4096;
// Whether only triangles count that the mask leaves.
layout(constant_id = 2) const uint kMasked = 0;
// What things cost, in box tests, and how many times the mask's cost must be left for it to pay, since what it leaves
// costs, too: as measured on lavapipe (docs/method.md, "The mask").
const uint kTrimCost = 1;
const uint kEstimateCost = 1;
const uint kSolveCost = 24;
const float kMaskPays = 1.5;
// Triangle pairs tested at a time, and room for what has passed until it is solved in double precision.
const uint kTested = 128;
const uint kQueue = 384;
// Cluster pairs looked through at a time for those of the round.
const uint kChosen = 256;

shared uint nearestGap;                 // over the cluster pairs left; floats >= 0 order as their bits
shared uint bucket[kBuckets];
shared uint chosenCount;
shared uint chosen[kChosen];
shared uint countA, countB;             // triangles left after trimming, and where they are in the frame
shared uint slotsA[kCluster], slotsB[kCluster];
shared vec3 cornersA[3 * kCluster], cornersB[3 * kCluster];
shared uvec2 tilesA[kCluster], tilesB[kCluster];  // where they are alive
shared uint listed;                     // triangles to look at
shared uint list[kCluster];
shared uint passed;                     // pairs of those that passed the tests: one of A, one of B << 8
shared uint passing[kTested];
shared uint touched;                    // bits of the least distance of a certain contact
shared uint queued;
shared uvec4 queue[kQueue];             // slot of a, slot of b, placement of b, bits of a lower bound
shared uint contended;
#ifndef RADAR_NO_DOUBLES
shared double laneHi[128];
double hi;       // as hiFloat, not rounded
#endif

float hiFloat;   // no contact is sought beyond, world units: D, or a certain contact
uint v, work, boxPairs, solved, spent, met, firstTiles;

vec3 framed(Rows frameFromMesh, vec3 q) {
  const vec4 p = vec4(q, 1.0);
  return vec3(dot(frameFromMesh[0], p), dot(frameFromMesh[1], p), dot(frameFromMesh[2], p));
}

// Whether a triangle can meet something in the box: they overlap across the motion, and it lies at the right depth. The
// box moves towards the triangle, or away from it where that is the sensor's.
bool reaches(vec3 low, vec3 high, float error, vec3 boxLow, vec3 boxHigh, bool isSensor) {
  low -= error;
  high += error;
  const bool across = all(lessThanEqual(low.xy, boxHigh.xy)) && all(lessThanEqual(boxLow.xy, high.xy));
  return across && (isSensor ? boxHigh.z >= low.z && boxLow.z - high.z <= hiFloat
                             : high.z >= boxLow.z && low.z - boxHigh.z <= hiFloat);
}

// The tiles of a cluster's triangle, or of any where `triangle` is kCluster.
uvec2 tilesOf(uint ref, uint triangle) { return tiles[kTilesPerCluster * (ref + firstTiles) + triangle]; }

// Lists the triangles of cluster `ref` that are alive where something of the other is; returns how many.
uint listAlive(uint ref, uint triangles_, uint other) {
  const uvec2 there = tilesOf(other, kCluster);
  barrier();
  if (gl_LocalInvocationID.x == 0) listed = 0;
  barrier();
  for (uint i = gl_LocalInvocationID.x; i < triangles_; i += kLanes) {
    if ((tilesOf(ref, i) & there) != uvec2(0)) list[atomicAdd(listed, 1)] = i;
  }
  barrier();
  return listed;
}

// Keeps the triangles of cluster `ref` that can meet something of cluster `other`.
void trim(uint ref, uint other, bool isSensor) {
  const uint placement = refs[ref].placement;
  const ClusterRecord node = nodes[meshes[placements[placement].mesh].firstNode + refs[ref].node];
  const vec3 boxLow = boxes[other].lo, boxHigh = boxes[other].hi;
  const float error = placements[placement].error;
  const Rows frameFromMesh = placements[placement].frameFromMesh;
  const MeshRecord mesh = meshes[placements[placement].mesh];
  const uint count = kMasked != 0 ? listAlive(ref, node.count, other) : node.count;
  for (uint k = gl_LocalInvocationID.x; k < count; k += kLanes) {
    const uint i = kMasked != 0 ? list[k] : k;
    const uvec3 corner = triangles[mesh.firstIndex / 3 + node.first + i] + mesh.firstVertex;
    const vec3 c0 = framed(frameFromMesh, positions[corner.x]), c1 = framed(frameFromMesh, positions[corner.y]),
               c2 = framed(frameFromMesh, positions[corner.z]);
    const vec3 low = min(min(c0, c1), c2), high = max(max(c0, c1), c2);
    if (!reaches(low, high, error, boxLow, boxHigh, isSensor)) continue;
    if (isSensor) {
      const uint at = atomicAdd(countA, 1);
      slotsA[at] = node.first + i;
      cornersA[3 * at] = c0;
      cornersA[3 * at + 1] = c1;
      cornersA[3 * at + 2] = c2;
      if (kMasked != 0) tilesA[at] = tilesOf(ref, i);
    } else {
      const uint at = atomicAdd(countB, 1);
      slotsB[at] = node.first + i;
      cornersB[3 * at] = c0;
      cornersB[3 * at + 1] = c1;
      cornersB[3 * at + 2] = c2;
      if (kMasked != 0) tilesB[at] = tilesOf(ref, i);
    }
  }
  work += (node.count / kLanes + 1) * kTrimWork;
  spent += node.count * kTrimCost;
}

// Whether an edge of p separates the projections of p and q by more than `error`.
bool separates(vec2 p0, vec2 p1, vec2 p2, vec2 q0, vec2 q1, vec2 q2, float error) {
  const vec2 normal = vec2(p1.y - p0.y, p0.x - p1.x);
  const float inner = dot(normal, p2 - p0);
  const float s = inner < 0.0 ? 1.0 : -1.0;  // q lies outside where s * dot(normal, q - p0) > 0
  const float outside = min(min(s * dot(normal, q0 - p0), s * dot(normal, q1 - p0)), s * dot(normal, q2 - p0));
  const vec2 far = max(max(abs(q0 - p0), abs(q1 - p0)), max(abs(q2 - p0), abs(p2 - p0)));
  // Corners off by `error` each turn the edge and move the points; products round.
  const float slack = 4.0 * error * (abs(normal.x) + abs(normal.y) + far.x + far.y) +
                      1e-6 * (abs(normal.x) * far.x + abs(normal.y) * far.y);
  // The third corner must be on the inner side for certain, or p is nothing but its edge.
  return outside > slack && abs(inner) > slack;
}

bool mayMeet(uint i, uint j, float error) {
  const bool alive = kMasked == 0 || (tilesA[i] & tilesB[j]) != uvec2(0);
  const vec3 a0 = cornersA[3 * i], a1 = cornersA[3 * i + 1], a2 = cornersA[3 * i + 2];
  const vec3 b0 = cornersB[3 * j], b1 = cornersB[3 * j + 1], b2 = cornersB[3 * j + 2];
  const vec3 loA = min(min(a0, a1), a2), hiA = max(max(a0, a1), a2), loB = min(min(b0, b1), b2), hiB = max(max(b0, b1), b2);
  const bool box = all(lessThanEqual(loA.xy, hiB.xy + error)) && all(lessThanEqual(loB.xy, hiA.xy + error)) &&
                   hiB.z + error >= loA.z && loB.z - hiA.z - error <= hiFloat;
  return alive && box && !separates(a0.xy, a1.xy, a2.xy, b0.xy, b1.xy, b2.xy, error) &&
         !separates(a1.xy, a2.xy, a0.xy, b0.xy, b1.xy, b2.xy, error) &&
         !separates(a2.xy, a0.xy, a1.xy, b0.xy, b1.xy, b2.xy, error) &&
         !separates(b0.xy, b1.xy, b2.xy, a0.xy, a1.xy, a2.xy, error) &&
         !separates(b1.xy, b2.xy, b0.xy, a0.xy, a1.xy, a2.xy, error) &&
         !separates(b2.xy, b0.xy, b1.xy, a0.xy, a1.xy, a2.xy, error);
}

// Solves a pair that passed the tests in float: queues it if it may be first.
void estimate(uint pair, float error, uint placement) {
  const uint i = pair & 0xffu, j = pair >> 8;
  const vec3 a[3] = vec3[3](cornersA[3 * i], cornersA[3 * i + 1], cornersA[3 * i + 2]);
  const vec3 b[3] = vec3[3](cornersB[3 * j], cornersB[3 * j + 1], cornersB[3 * j + 2]);
  const MeetingFloat m = meetingOf(a, b, error);
  const float low = max(min(m.earliest, m.unknown), 0.0);
  if (m.latest >= 0.0 && low <= hiFloat) {
    queue[atomicAdd(queued, 1)] = uvec4(slotsA[i], slotsB[j], placement, floatBitsToUint(low));
  }
  // Distances of at least 0 order as their bits.
  if (m.ahead) atomicMin(touched, floatBitsToUint(max(m.by, 0.0)));
}

// No room for what the next step may find.
bool overflows() { return contended + kLanes > targets[v].contenderCapacity; }

// Forgets what of the queue has turned out not to be first; returns what is left.
uint tightenQueue() {
  const uint count = queued;
  barrier();
  if (gl_LocalInvocationID.x == 0) queued = 0;
  for (uint first = 0; first < count; first += kLanes) {
    const uint q = first + gl_LocalInvocationID.x;
    const uvec4 entry = queue[min(q, count - 1)];
    barrier();
    if (q < count && uintBitsToFloat(entry.w) <= hiFloat) queue[atomicAdd(queued, 1)] = entry;
    barrier();
  }
  work += count / kLanes + 1;
  return queued;
}

#ifndef RADAR_NO_DOUBLES
// Solves a pair in double precision: lists it if it may be first.
void solve(uvec4 entry, bool live) {
  const double length = targets[v].directionLength;
  const dvec3 direction = dvec3(targets[v].direction[0], targets[v].direction[1], targets[v].direction[2]);
  const uint object = placements[entry.z].object;
  dvec3 a[3], b[3];
  placedCorners(targets[v].pose, targets[v].mesh, entry.x, a);
  placedCorners(objects[object].pose, objects[object].mesh, entry.y, b);
  const Meeting m = meetingOf(a, b, direction);
  const double low = max(min(m.earliest, m.unknown), 0.0LF) * length * (1.0LF - 8.881784197001252e-16LF);
  laneHi[gl_LocalInvocationID.x] = live && m.ahead ? max(m.by, 0.0LF) * length * (1.0LF + 8.881784197001252e-16LF) : kNever;
  barrier();
  for (uint i = 0; i < kLanes; ++i) hi = min(hi, laneHi[i]);
  if (live && m.latest >= 0.0LF && low <= hi) {
    const bool sharp = m.ahead && m.at - m.error > 0.0LF && min(m.others, m.unknown) > m.by;
    const uint flags = (m.ahead ? kContenderMeets : 0) | (m.ahead && m.by < 0.0LF ? kContenderPierces : 0) |
                       (sharp ? kContenderSharp : 0) | (m.feature & 0xffu);
    contenders[targets[v].firstContender + atomicAdd(contended, 1)] =
        Contender(low, m.at, m.error, object, entry.y, entry.x, flags);
  }
  barrier();
}
#else
void solve(uvec4 entry, bool live) {
  if (live) {
    contenders[targets[v].firstContender + atomicAdd(contended, 1)] =
        Contender(doubleBits(uintBitsToFloat(entry.w)), uvec2(0), uvec2(0), placements[entry.z].object, entry.y, entry.x, 0);
  }
  barrier();
}
#endif

// Only "within D or not" is asked, and a contact within D is certain.
bool decided() { return hiFloat < targets[v].enough; }

// Solves all that is queued.
void flush() {
  barrier();
  const uint count = tightenQueue();
#ifndef RADAR_NO_DOUBLES
  hi = min(hi, double(hiFloat));
#endif
  for (uint first = 0; first < count && !overflows() && !decided(); first += kLanes) {
    const uint q = first + gl_LocalInvocationID.x;
    solve(queue[min(q, count - 1)], q < count);
    work += kSolveWork + kLanes;
    solved += min(kLanes, count - first);
    spent += min(kLanes, count - first) * kSolveCost;
  }
#ifndef RADAR_NO_DOUBLES
  hiFloat = min(hiFloat, float(hi) * 1.000001 + 1e-37);
#endif
  barrier();
  if (gl_LocalInvocationID.x == 0) queued = 0;
  barrier();
}

// All triangle pairs of one pair of clusters.
void meetClusters(ClusterPair pair) {
  if (kMasked != 0 && (tilesOf(pair.a, kCluster) & tilesOf(pair.b, kCluster)) == uvec2(0)) return;
  barrier();
  if (gl_LocalInvocationID.x == 0) countA = countB = 0;
  barrier();
  trim(pair.a, pair.b, true);
  trim(pair.b, pair.a, false);
  barrier();
  const uint placement = refs[pair.b].placement;
  const float error = 2.0 * (placements[refs[pair.a].placement].error + placements[placement].error);
  const uint all_ = countA * countB;
  const float perRow = 1.0 / float(max(countB, 1));  // dividing integers costs lavapipe more than the test
  for (uint first = 0; first < all_; first += kTested) {
    const uint end = min(first + kTested, all_);
    for (uint p = first + gl_LocalInvocationID.x; p < end; p += kLanes) {
      const uint i = uint((float(p) + 0.5) * perRow), j = p - i * countB;
      if (mayMeet(i, j, error)) passing[atomicAdd(passed, 1)] = i | j << 8;
    }
    barrier();
    const uint count = passed;
    for (uint p = gl_LocalInvocationID.x; p < count; p += kLanes) estimate(passing[p], error, placement);
    barrier();
    hiFloat = min(hiFloat, uintBitsToFloat(touched));
    if (gl_LocalInvocationID.x == 0) passed = 0;
    work += (end - first + count) / kLanes + 2;
    spent += count * kEstimateCost;
    barrier();
    if (queued > kQueue - kTested) flush();
  }
  boxPairs += all_;
  spent += all_;
  ++met;
}

bool goesOn() { return work < kWorkPerDispatch && !overflows() && !decided(); }

// A round stops to ask what is left when it has cost as much as the mask.
uint pauseAt() {
  const uint cost = targets[v].maskCost;
  return kMasked != 0 || spent > kNoMask - cost ? kNobody : spent + cost;
}

// Whether the mask pays: `left` cluster pairs, at what those so far have cost, are dearer.
bool asksMask(uint left) {
  if (kMasked != 0 || met == 0 || targets[v].maskCost == kNoMask) return false;
  return float(left) * float(spent) > kMaskPays * float(targets[v].maskCost) * float(met);
}

// All cluster pairs of `count` that are no farther than `limit`, until that has cost `pause` in all.
void meetNearest(uint first, uint count, float limit, uint pause) {
  for (uint i = gl_LocalInvocationID.x; i < count; i += kLanes) {
    const float gap = pairs[first + i].gap;
    if (gap >= 0.0 && gap <= min(limit, hiFloat)) chosen[atomicAdd(chosenCount, 1)] = first + i;
  }
  barrier();
  const uint found = chosenCount;
  work += count / kLanes + found + 1;
  for (uint i = 0; i < found && goesOn() && spent < pause; ++i) {
    const ClusterPair pair = pairs[chosen[i]];
    if (pair.gap > hiFloat) continue;
    meetClusters(pair);
    if (gl_LocalInvocationID.x == 0) pairs[chosen[i]].gap = -1.0;
  }
  barrier();
  if (gl_LocalInvocationID.x == 0) chosenCount = 0;
  barrier();
}

// The gap up to which this round goes: that of the round's quota of nearest pairs, in steps of a bucket. `within`: how many
// are no farther than what is known to be touched.
float roundLimit(uint first, uint count, float nearest, uint quota, out uint within) {
  const float width = max(hiFloat - nearest, 1e-30) / float(kBuckets);
  for (uint i = gl_LocalInvocationID.x; i < kBuckets; i += kLanes) bucket[i] = 0;
  barrier();
  for (uint i = gl_LocalInvocationID.x; i < count; i += kLanes) {
    const float gap = pairs[first + i].gap;
    if (gap >= 0.0 && gap <= hiFloat) atomicAdd(bucket[min(uint((gap - nearest) / width), kBuckets - 1)], 1);
  }
  barrier();
  uint sum = 0, last = 0;
  within = 0;
  for (uint i = 0; i < kBuckets; ++i) within += bucket[i];
  while (last + 1 < kBuckets && sum + bucket[last] < quota) sum += bucket[last++];
  work += count / kLanes + 3 * kBuckets;
  return last + 1 == kBuckets ? hiFloat : nearest + width * float(last + 1);
}

void main() {
  v = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (v >= push.count) return;
  if (states[v].progress != (kMasked != 0 ? kSearchMasked : kSearchUnfinished)) return;
  const uint total = states[v].pairCount;
  uint cursor = states[v].cursor;
  if (total > targets[v].pairCapacity) {
    if (gl_LocalInvocationID.x == 0) states[v].progress = kSearchOverflow;
    return;
  }
  hiFloat = states[v].hi;
#ifndef RADAR_NO_DOUBLES
  hi = double(hiFloat);
#endif
  work = boxPairs = solved = 0;
  spent = states[v].spent;
  met = states[v].met;
  firstTiles = states[v].tiles;
  if (gl_LocalInvocationID.x == 0) {
    queued = passed = chosenCount = 0;
    touched = floatBitsToUint(hiFloat);
    contended = states[v].contenderCount;
  }
  barrier();
  uint round = states[v].round;
  bool asks = false;
  while (cursor < total && goesOn()) {
    const uint first = targets[v].firstPair + cursor, count = min(kRun, total - cursor);
    barrier();
    if (gl_LocalInvocationID.x == 0) nearestGap = kNobody;
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < count; i += kLanes) {
      const float gap = pairs[first + i].gap;
      if (gap >= 0.0) atomicMin(nearestGap, floatBitsToUint(gap));
    }
    work += count / kLanes + 1;
    barrier();
    if (nearestGap == kNobody || uintBitsToFloat(nearestGap) > hiFloat) {
      cursor += count;
      round = 0;
      continue;
    }
    uint within;
    const float limit = roundLimit(first, count, uintBitsToFloat(nearestGap), kFirstRound << (2 * min(round, 12u)), within);
    asks = asksMask(within + total - cursor - count);
    if (asks) break;
    const uint pause = pauseAt();
    for (uint start = 0; start < count && goesOn() && spent < pause; start += kChosen) {
      meetNearest(first + start, min(kChosen, count - start), limit, pause);
    }
    flush();
    memoryBarrierBuffer();
    barrier();
    ++round;
  }
  barrier();
  if (gl_LocalInvocationID.x == 0) {
    states[v].hi = hiFloat;
    states[v].contenderCount = contended;
    if (decided() || (cursor >= total && !overflows())) {
      states[v].progress = kSearchDone;
    } else if (overflows()) {
      states[v].progress = kSearchOverflow;
    } else if (asks) {
      states[v].progress = kSearchAsksMask;
    }
    states[v].boxPairs += boxPairs;
    states[v].solved += solved;
    states[v].round = round;
    states[v].cursor = cursor;
    states[v].spent = spent;
    states[v].met = met;
  }
}
