// The search for a sensor's first contact: one subgroup per sensor goes through its cluster pairs, nearest first, in rounds
// of 16, 64, 256, ... until the next is farther than what is known to be touched. Within a pair of clusters both sides are
// trimmed against the other's box, triangles' boxes are tested along axes of the pair's own, and what is left is solved in
// float; what may then still be first is solved in double precision. With RADAR_NO_DOUBLES, on a device without, that is left to
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
// What things cost, in triangles trimmed, and how many times the mask's cost must be left for it to pay, since what it leaves
// costs, too: as measured on lavapipe (docs/method.md, "The mask").
const uint kTrimCost = 1;
const uint kEstimateCost = 1;
const uint kSolveCost = 24;
const float kMaskPays = 3.0;
// Triangle pairs solved in float at a time, and room for what may be first until it is solved in double precision.
const uint kTested = 128;
const uint kQueue = 256;
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
shared vec3 lowA[kCluster], highA[kCluster];  // boxes along the axes of the pair of clusters
shared uvec2 meetsB[kCluster];          // which of A the box of one of B meets
shared uint anyMeets;                   // of those, or of what is left of them
shared uint listed;                     // triangles to look at
shared uint list[kCluster];
shared uint passed;                     // pairs whose boxes meet: one of A, one of B << 8
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

// The axes of a pair of clusters: along its longest edge as seen along the motion, across that, and depth less what that edge
// climbs (docs/method.md, "Axes of a pair of clusters").
vec2 along;
float climb;
vec3 margin;       // of a pair of boxes along those axes
float pairError;   // and of a pair of triangles in the frame
uint placementB;

vec3 turned(vec3 c) {
  const float u = dot(along, c.xy);
  return vec3(u, along.x * c.y - along.y * c.x, c.z - climb * u);
}

// Whether boxes along those axes let a triangle or more of B meet some of A.
bool meets(vec3 lowOfA, vec3 highOfA, vec3 lowOfB, vec3 highOfB) {
  const vec3 first = vec3(lowOfB.xy - margin.xy, lowOfB.z - margin.z - hiFloat), last = highOfB + margin;
  return !(any(greaterThan(first, highOfA)) || any(greaterThan(lowOfA, last)));
}

void chooseAxes(ClusterPair pair) {
  const vec3 a = boxes[pair.a].edge, b = boxes[pair.b].edge;
  const vec3 edge = dot(a.xy, a.xy) > dot(b.xy, b.xy) ? a : b;
  const float across = length(edge.xy);
  const bool usable = across > 1e-15 && across < 1e15;
  along = usable ? edge.xy / across : vec2(1.0, 0.0);
  climb = usable && abs(edge.z) < 16.0 * across ? edge.z / across : 0.0;
  placementB = refs[pair.b].placement;
  pairError = 2.0 * (placements[refs[pair.a].placement].error + placements[placementB].error);
  margin = (pairError + 1e-36) * vec3(1.5, 1.5, 2.0 + 2.0 * abs(climb));
}

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

bool sharesTiles(ClusterPair pair) {
  return kMasked == 0 || (tilesOf(pair.a, kCluster) & tilesOf(pair.b, kCluster)) != uvec2(0);
}

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

// Chooses a pair of clusters' axes and trims the sensor's; returns whether something is left of it.
bool trimSensor(ClusterPair pair) {
  chooseAxes(pair);
  barrier();
  if (gl_LocalInvocationID.x == 0) countA = 0;
  barrier();
  trim(pair.a, pair.b, true);
  ++met;
  barrier();
  return countA != 0;
}

// Takes the first of a set of triangles.
uint takeFirst(inout uvec2 set) {
  const bool lower = set.x != 0;
  const uint i = lower ? findLSB(set.x) : 32 + findLSB(set.y);
  set = lower ? uvec2(set.x & (set.x - 1), set.y) : uvec2(0, set.y & (set.y - 1));
  return i;
}

// The box of a triangle of B along the axes.
void boxOfB(uint j, out vec3 low, out vec3 high) {
  const vec3 c0 = turned(cornersB[3 * j]), c1 = turned(cornersB[3 * j + 1]), c2 = turned(cornersB[3 * j + 2]);
  low = min(min(c0, c1), c2);
  high = max(max(c0, c1), c2);
}

// Finds which triangles' boxes meet: an invocation takes a few neighbours of B, first the box around them.
void meetBoxes() {
  const uint few = (countB + kLanes - 1) / kLanes;
  const uint begin = min(gl_LocalInvocationID.x * few, countB), end = min(begin + few, countB);
  vec3 low = vec3(3.0e38), high = vec3(-3.0e38);
  for (uint j = begin; j < end; ++j) {
    vec3 lowB, highB;
    boxOfB(j, lowB, highB);
    low = min(low, lowB);
    high = max(high, highB);
    meetsB[j] = uvec2(0);
  }
  uvec2 near = uvec2(0);
  for (uint i = 0; i < countA; ++i) {
    const uint bit = meets(lowA[i], highA[i], low, high) ? 1u << (i & 31) : 0;
    near |= i < 32 ? uvec2(bit, 0) : uvec2(0, bit);
  }
  if (begin == end) near = uvec2(0);
  if (few == 1 && near != uvec2(0)) meetsB[begin] = near;
  bool found = few == 1 && near != uvec2(0);
  for (uint j = begin; j < end && few > 1 && near != uvec2(0); ++j) {
    vec3 lowB, highB;
    boxOfB(j, lowB, highB);
    uvec2 left = near, bits = uvec2(0);
    while (left != uvec2(0)) {
      const uint i = takeFirst(left);
      const uint bit = meets(lowA[i], highA[i], lowB, highB) ? 1u << (i & 31) : 0;
      bits |= i < 32 ? uvec2(bit, 0) : uvec2(0, bit);
    }
    meetsB[j] = bits;
    found = found || bits != uvec2(0);
  }
  if (found) anyMeets = 1;
  spent += countA;
  work += countA * (few + 1) + 2 * few;
}

// Trims the scene's triangles of a pair of clusters and finds which boxes meet; returns whether any do.
bool trimScene(ClusterPair pair) {
  if (gl_LocalInvocationID.x == 0) countB = anyMeets = 0;
  barrier();
  trim(pair.b, pair.a, false);
  for (uint i = gl_LocalInvocationID.x; i < countA; i += kLanes) {
    const vec3 c0 = turned(cornersA[3 * i]), c1 = turned(cornersA[3 * i + 1]), c2 = turned(cornersA[3 * i + 2]);
    lowA[i] = min(min(c0, c1), c2);
    highA[i] = max(max(c0, c1), c2);
  }
  barrier();
  meetBoxes();
  barrier();
  boxPairs += countA * countB;
  return anyMeets != 0;
}

// Solves the triangle pairs whose boxes meet, as many at a time as there is room for.
void meetTriangles() {
  barrier();
  uint first = 0;
  while (first < countB) {
    uint count = 0;
    while (first < countB && count + kLanes <= kTested) {
      const uint j = first + gl_LocalInvocationID.x;
      uvec2 bits = j < countB ? meetsB[j] : uvec2(0);
      if (gl_LocalInvocationID.x == 0) anyMeets = 0;
      barrier();
      for (uint step = 0; step < (kTested - count) / kLanes && bits != uvec2(0); ++step) {
        const uint i = takeFirst(bits);
        if (kMasked == 0 || (tilesA[i] & tilesB[j]) != uvec2(0)) passing[atomicAdd(passed, 1)] = i | j << 8;
      }
      if (j < countB) meetsB[j] = bits;
      if (bits != uvec2(0)) anyMeets = 1;
      barrier();
      count = passed;
      if (anyMeets == 0) first += kLanes;
      work += kTested / kLanes + 1;
      barrier();
    }
    for (uint p = gl_LocalInvocationID.x; p < count; p += kLanes) estimate(passing[p], pairError, placementB);
    barrier();
    hiFloat = min(hiFloat, uintBitsToFloat(touched));
    if (gl_LocalInvocationID.x == 0) passed = 0;
    work += count / kLanes + 1;
    spent += count * kEstimateCost;
    barrier();
    if (queued > kQueue - kTested) flush();
  }
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
  for (uint i = 0; i < found && goesOn() && spent < pause;) {
    // Pairs are trimmed until one has something to solve: lavapipe runs both sides of an `if`, but leaves a loop.
    bool meeting = false;
    while (i < found && work < kWorkPerDispatch && spent < pause && !meeting) {
      bool sensorLeft = false;
      ClusterPair pair;
      while (i < found && work < kWorkPerDispatch && spent < pause && !sensorLeft) {
        pair = pairs[chosen[i]];
        if (pair.gap <= hiFloat) {
          sensorLeft = sharesTiles(pair) && trimSensor(pair);
          if (gl_LocalInvocationID.x == 0) pairs[chosen[i]].gap = -1.0;
        }
        ++i;
      }
      if (sensorLeft) meeting = trimScene(pair);
    }
    if (meeting) meetTriangles();
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
