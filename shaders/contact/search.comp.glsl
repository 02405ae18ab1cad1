// The search for first contact. A workgroup is one subgroup. Each lane walks the trees for one sensor: down the tree over
// objects, then down both meshes' trees together, nearest first, with the other nodes on a stack. The lanes share a queue of
// leaf pairs and a queue of triangle pairs that may meet, so that all lanes take part in the expensive tests. When the budget
// ends or a stack is nearly full, pending nodes become tasks of the next round; none is dropped silently.
//
// All lanes leave a loop together, so that `work` counts as lavapipe does: it silently ends loops after 65,535 iterations of
// a subgroup in total.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/triangle_pair_bounds.glsl"
#include "shared/scene.glsl"
#include "nodes.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;
layout(constant_id = 1) const uint kQueue = 256;     // pairs in each queue: at least 6 times the lanes
layout(constant_id = 2) const uint kStack = 40;      // entries of a lane: at least 4
// Whether any query has a clearance. Constant, because some devices execute what they skip.
layout(constant_id = 3) const bool kHasClearances = false;

layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotTasks) readonly restrict buffer Tasks { SearchTask tasks[]; };
layout(scalar, binding = kSlotSpilled) writeonly restrict buffer Spilled { SearchTask spilled[]; };
layout(scalar, binding = kSlotCandidatePairs) writeonly restrict buffer Candidates { CandidatePair candidates[]; };
layout(scalar, binding = kSlotExcluded) readonly restrict buffer Excluded { uint excluded[]; };

layout(push_constant) uniform PushConstants { SearchPush push; };

// A sensor's clearance, scaled, rounded up.
float clearanceOf(uint sensor) { return kHasClearances ? sensorTexel(sensor, kTexelFrame).w : 0.0; }

#include "node_pair.glsl"
#include "triangle_pair.glsl"
#include "within_clearance.glsl"

// A loop goes on only if at least this many lanes have work in it; otherwise all lanes leave it to fetch work.
const uint kFew = (kLanes + 1) / 2;
// Iterations of a loop over nodes before the queues are checked.
const uint kObjectSteps = 16, kNodeSteps = 24;
// Number of leaf pairs from which on their triangles are tested.
const uint kLeafBatch = kQueue / 4;
// Budget while there are too few tasks for the device, so that they are soon split into more.
const uint kSplitBudget = 48;

shared uvec4 leafQueue[kQueue];      // link of a, link of b, object, sensor
shared float leafGaps[kQueue];
shared uvec4 pairQueue[kQueue];      // slot of a, slot of b, object, sensor
shared SearchTask gifts[kLanes];     // from lanes with several entries to idle lanes

// The same in all lanes.
uint leafHead, leafTail, pairHead, pairTail, work;
bool tasksLeft;

// Of a lane.
uint sensor, object;
float limit;                         // contacts beyond this do not count, scaled
uint least;                          // SearchState::least: greater objects do not count
uvec3 stack[kStack];                 // a, b, gap of a SearchTask; for the tree over objects: kNobody, link, gap
uint depth, objectDepth;             // entries in use; those of the tree over objects come first
uvec3 current;                       // the pair to test next; none if x is kNobody
MeshPair meshes;
uint trianglePairs;
// Of its sensor.
SensorBox box;
float scale, unscale, stopBefore;

uint countOf(bool has) { return subgroupBallotBitCount(subgroupBallot(has)); }
uint rankOf(uvec4 ballot) { return subgroupBallotExclusiveBitCount(ballot); }

// Contacts beyond this do not count. It is negative, which ends the search, if an `anyHit` query has a certain contact or the
// search has failed.
float limitOf(SearchState state, float enoughOfS) {
  const float hi = uintBitsToFloat(state.hi);
  return hi < enoughOfS || state.flags != 0 ? -1.0 : hi;
}

// The limit for an object. If a lesser object certainly meets at the start, this one cannot be the answer.
float limitOf(uint s, uint objectB) {
  const SearchState state = states[s];
  return objectB > state.least ? -1.0 : limitOf(state, sensorTexel(s, kTexelHalfExtent).w);
}

void pushLeaves(bool has, Node a, Node b, float gap) {
  const uvec4 who = subgroupBallot(has);
  const uint at = (leafTail + rankOf(who)) % kQueue;
  if (has) {
    leafQueue[at] = uvec4(a.link, b.link, object, sensor);
    leafGaps[at] = gap;
  }
  leafTail += subgroupBallotBitCount(who);
}

void pushPair(bool has, uint slotA, uint slotB, uint objectB, uint sensorA) {
  const uvec4 who = subgroupBallot(has);
  if (has) pairQueue[(pairTail + rankOf(who)) % kQueue] = uvec4(slotA, slotB, objectB, sensorA);
  pairTail += subgroupBallotBitCount(who);
}

// The stack entry that descends the larger of two nodes, which are not both leaves.
uvec3 entryOf(uint ia, Node a, uint ib, Node b, Approach approach) {
  const bool intoA = isLeaf(b.link) || (!isLeaf(a.link) && approach.sizeA > approach.sizeB);
  const uint gap = floatBitsToUint(approach.gap);
  return intoA ? uvec3(a.link | kLinkLeaf, ib, gap) : uvec3(ia, b.link, gap);
}

bool isIdle() { return current.x == kNobody && depth == 0; }

// ---- tasks -------------------------------------------------------------------------------------------------------------

void loadSensor() {
  box = sensorBoxOf(sensor);
  scale = sensorTexel(sensor, kTexelDirection).w;
  unscale = sensorTexel(sensor, kTexelMask).w;
  stopBefore = sensorTexel(sensor, kTexelHalfExtent).w;
}

// Begins a task; returns its object, or kNobody if it is a node of the tree over objects or no longer counts.
uint begin(SearchTask task) {
  sensor = task.sensor;
  loadSensor();
  const SearchState state = states[sensor];
  if (task.gap > limitOf(state, stopBefore) || (task.object != kNobody && task.object > state.least)) return kNobody;
  if (task.object == kNobody) {
    stack[0] = uvec3(kNobody, task.b, floatBitsToUint(task.gap));
    depth = objectDepth = 1;
    return kNobody;
  }
  current = uvec3(task.a, task.b, floatBitsToUint(task.gap));
  depth = objectDepth = 0;
  return task.object;
}

// Gives tasks to idle lanes while there are any; returns the object of the lane's new task, or kNobody.
uint takeTasks() {
  const bool idle = isIdle();
  const uvec4 who = subgroupBallot(idle && tasksLeft);
  const uint wanted = subgroupBallotBitCount(who);
  uint first = 0;
  if (subgroupElect() && wanted != 0) first = atomicAdd(counts.rounds[push.round].taken, wanted);
  first = subgroupBroadcastFirst(first);
  const uint at = first + rankOf(who), count = counts.rounds[push.round].tasks;
  uint named = kNobody;
  if (idle && tasksLeft && at < count) named = begin(tasks[at]);
  tasksLeft = tasksLeft && first + wanted < count;
  return named;
}

// Once all tasks are taken, lanes with more than one entry give their oldest, which is the largest, to idle lanes.
uint shareTasks(uint named) {
  const bool idle = isIdle() && !tasksLeft, gives = !tasksLeft && depth > 0 && depth + (current.x != kNobody ? 1 : 0) > 1;
  const uvec4 idleLanes = subgroupBallot(idle), givers = subgroupBallot(gives);
  const uint gifted = min(subgroupBallotBitCount(idleLanes), subgroupBallotBitCount(givers));
  if (gives && rankOf(givers) < gifted) {
    const uvec3 entry = stack[0];
    gifts[rankOf(givers)] =
        SearchTask(sensor, objectDepth > 0 ? kNobody : object, entry.x, entry.y, uintBitsToFloat(entry.z));
    // The last entry of each kind fills the hole.
    if (objectDepth > 0) {
      stack[0] = stack[objectDepth - 1];
      stack[objectDepth - 1] = stack[depth - 1];
      --objectDepth;
    } else {
      stack[0] = stack[depth - 1];
    }
    --depth;
  }
  subgroupBarrier();
  if (idle && rankOf(idleLanes) < gifted) named = begin(gifts[rankOf(idleLanes)]);
  subgroupBarrier();
  return named;
}

// Turns pending entries into tasks of the next round.
void spill() {
  while (countOf(!isIdle()) != 0) {
    const bool has = !isIdle();
    uvec3 entry = current;
    uint named = object;
    if (current.x == kNobody && has) {
      entry = stack[--depth];
      if (depth < objectDepth) {
        named = kNobody;
        objectDepth = depth;
      }
    }
    current.x = kNobody;
    const bool keeps = has && uintBitsToFloat(entry.z) <= limit && (named == kNobody || named <= least);
    const uvec4 who = subgroupBallot(keeps);
    uint first = 0;
    if (subgroupElect()) first = atomicAdd(counts.rounds[push.round].spilled, subgroupBallotBitCount(who));
    first = subgroupBroadcastFirst(first);
    const uint at = first + rankOf(who);
    if (keeps && at < push.taskCapacity) {
      spilled[at] = SearchTask(sensor, named, entry.x, entry.y, uintBitsToFloat(entry.z));
    } else if (keeps) {
      atomicOr(states[sensor].flags, kSearchLost);
    }
  }
}

// ---- nodes -------------------------------------------------------------------------------------------------------------

// Lanes without an object walk the tree over objects until they find one.
uint findObjects(uint named) {
  for (uint step = 0; step < kObjectSteps; ++step) {
    const bool searching =
        named == kNobody && current.x == kNobody && depth > 0 && depth == objectDepth && depth < kStack;
    const uint count = countOf(searching);
    if (count == 0 || (count < kFew && step > 0)) break;
    ++work;
    if (searching) {
      const uvec3 entry = stack[--depth];
      const bool near = uintBitsToFloat(entry.z) <= limit, leaf = isLeaf(entry.y);
      if (near && leaf && (entry.y & kLinkItem) <= least) named = entry.y & kLinkItem;
      const int t = near && !leaf ? int(2 * entry.y) : 0;
      const uvec4 x0 = texelFetch(objectNodeTexels, t), x1 = texelFetch(objectNodeTexels, t + 2);
      const vec2 at0 = meetsBox(box, uintBitsToFloat(x0), uintBitsToFloat(texelFetch(objectNodeTexels, t + 1))),
                 at1 = meetsBox(box, uintBitsToFloat(x1), uintBitsToFloat(texelFetch(objectNodeTexels, t + 3)));
      const float most = limit * unscale;
      const bool meets0 = near && !leaf && at0.x <= at0.y && at0.x <= most, meets1 = near && !leaf && at1.x <= at1.y && at1.x <= most;
      const bool swap = meets1 && (!meets0 || at1.x < at0.x);
      const uvec3 entry0 = uvec3(kNobody, x0.w, floatBitsToUint(at0.x * scale)),
                  entry1 = uvec3(kNobody, x1.w, floatBitsToUint(at1.x * scale));
      if (meets0 && meets1) stack[depth++] = swap ? entry0 : entry1;
      if (meets0 || meets1) stack[depth++] = swap ? entry1 : entry0;
      objectDepth = depth;
    }
  }
  return named;
}

// Whether the object shares a mask bit with the query and is not excluded.
bool isEligible(uint named) {
  const uvec4 asks = sensorBits(sensor, kTexelMask);
  // Excluded objects are in ascending order.
  uint first = asks.y, end = asks.z;
  while (countOf(first < end) != 0) {
    ++work;
    const uint middle = (first + end) / 2;
    if (first < end) {
      if (excluded[middle] < named) {
        first = middle + 1;
      } else {
        end = middle;
      }
    }
  }
  const bool isExcluded = first < asks.z && excluded[first] == named;
  return !isExcluded && (objectBits(named, kTexelError).z & asks.x) != 0;
}

// Lanes with a new object begin at its root, or at the nodes of their task (`current`).
void enterObjects(uint named) {
  bool leaves = false;
  Node a, b;
  Approach approach;
  ++work;
  // All lanes run the loop over excluded objects.
  const bool enters = isEligible(named == kNobody ? 0 : named) && named != kNobody;
  if (enters) {
    object = named;
    meshes = meshPairOf(sensor, object);
    if (!meshes.inRange) atomicOr(states[sensor].flags, kSearchOutOfRange);
    if (current.x == kNobody && meshes.inRange) {
      const uint rootA = sensorBits(sensor, kTexelReach).w, rootB = objectBits(object, kTexelReach).w;
      a = nodeAt(rootA);
      b = nodeAt(rootB);
      approach = approachOf(meshes, a, b, limit);
      const bool meets = approach.gap < kMiss;
      leaves = meets && isLeaf(a.link & b.link);
      if (meets && !leaves) current = entryOf(rootA, a, rootB, b, approach);
    }
  }
  pushLeaves(leaves, a, b, approach.gap);
}

// Descends both meshes' trees: tests the two children of one node with the other node.
void descend() {
  // Whether lanes without work could find some after the loop.
  const bool more = countOf(current.x == kNobody && (depth > 0 || tasksLeft)) != 0;
  for (uint step = 0; step < kNodeSteps; ++step) {
    if (current.x == kNobody && depth > objectDepth) current = stack[--depth];
    const bool tries = current.x != kNobody && depth < kStack;
    const uint count = countOf(tries);
    if (count == 0 || leafTail - leafHead + 2 * kLanes > kQueue || (count < kFew && step > 0 && more)) break;
    ++work;
    bool leaves0 = false, leaves1 = false;
    Node a0, a1, b0, b1;
    Approach at0, at1;
    const bool near = tries && uintBitsToFloat(current.z) <= limit && object <= least;
    if (near) {
      const bool intoA = isLeaf(current.x);
      const uint child = intoA ? current.x & kLinkItem : current.y, other = intoA ? current.y : current.x;
      const Node child0 = nodeAt(child), child1 = nodeAt(child + 1), stays = nodeAt(other);
      if (intoA) {
        a0 = child0;
        a1 = child1;
        b0 = b1 = stays;
      } else {
        a0 = a1 = stays;
        b0 = child0;
        b1 = child1;
      }
      at0 = approachOf(meshes, a0, b0, limit);
      at1 = approachOf(meshes, a1, b1, limit);
      leaves0 = at0.gap < kMiss && isLeaf(a0.link & b0.link);
      leaves1 = at1.gap < kMiss && isLeaf(a1.link & b1.link);
      const bool goes0 = at0.gap < kMiss && !leaves0, goes1 = at1.gap < kMiss && !leaves1;
      const bool swap = goes1 && (!goes0 || at1.gap < at0.gap);
      const uvec3 entry0 = entryOf(intoA ? child : other, a0, intoA ? other : child, b0, at0),
                  entry1 = entryOf(intoA ? child + 1 : other, a1, intoA ? other : child + 1, b1, at1);
      if (goes0 && goes1) stack[depth++] = swap ? entry0 : entry1;
      current = swap ? entry1 : entry0;
      if (!goes0 && !goes1) current.x = kNobody;
    } else if (tries) {
      current.x = kNobody;
    }
    pushLeaves(leaves0, a0, b0, at0.gap);
    pushLeaves(leaves1, a1, b1, at1.gap);
  }
}

// ---- triangles ---------------------------------------------------------------------------------------------------------

// Tests the pairs of triangles, up to two per leaf, and queues those that may meet. `all`: until no leaf is left.
void tryLeaves(bool all) {
  while ((leafTail - leafHead >= kLanes || (all && leafTail != leafHead)) && pairTail - pairHead + 4 * kLanes <= kQueue) {
    ++work;
    const uint at = leafHead + gl_SubgroupInvocationID;
    bool meets[4] = bool[4](false, false, false, false);
    uvec4 entry = uvec4(0);
    if (at < leafTail) {
      entry = leafQueue[at % kQueue];
      const float bound = limitOf(entry.w, entry.z);
      if (leafGaps[at % kQueue] <= bound) {
        ++trianglePairs;
        const uint slotA = entry.x & kLinkItem, slotB = entry.y & kLinkItem;
        const bool twoA = (entry.x & kLinkPair) != 0, twoB = (entry.y & kLinkPair) != 0;
        const PairFrame f = pairFrameOf(entry.w, entry.z, vertexAt(triangleAt(slotA).x), vertexAt(triangleAt(slotB).x));
        const PlacedTriangle a0 = placedA(f, slotA), a1 = placedA(f, slotA + (twoA ? 1 : 0)), b0 = placedB(f, slotB),
                             b1 = placedB(f, slotB + (twoB ? 1 : 0));
        const float clearance = clearanceOf(entry.w);
        meets = bool[4](mayMeet(a0, b0, clearance, bound), twoB && mayMeet(a0, b1, clearance, bound),
                        twoA && mayMeet(a1, b0, clearance, bound), twoA && twoB && mayMeet(a1, b1, clearance, bound));
      }
    }
    const uint slotA = entry.x & kLinkItem, slotB = entry.y & kLinkItem;
    pushPair(meets[0], slotA, slotB, entry.z, entry.w);
    pushPair(meets[1], slotA, slotB + 1, entry.z, entry.w);
    pushPair(meets[2], slotA + 1, slotB, entry.z, entry.w);
    pushPair(meets[3], slotA + 1, slotB + 1, entry.z, entry.w);
    leafHead = min(leafHead + kLanes, leafTail);
  }
}

void keepCandidate(bool keeps, uvec4 pair, float low, uint feature) {
  const uvec4 who = subgroupBallot(keeps);
  uint first = 0;
  if (subgroupElect()) first = atomicAdd(counts.candidates, subgroupBallotBitCount(who));
  first = subgroupBroadcastFirst(first);
  // So that the count cannot wrap, however many candidates are lost.
  if (first > push.candidateCapacity && subgroupElect()) atomicMin(counts.candidates, push.candidateCapacity + 1);
  const uint at = first + rankOf(who);
  if (keeps && at < push.candidateCapacity) {
    candidates[at] = CandidatePair(pair.w, pair.z, pair.x, pair.y, low, feature);
  } else if (keeps) {
    atomicOr(states[pair.w].flags, kSearchLost);
  }
}

// Solves pairs in float: lowers the upper bound of first contact, and keeps the pairs that may be first as candidates.
void solvePairs(bool all) {
  while (pairTail - pairHead >= kLanes || (all && pairTail != pairHead)) {
    work += kHasClearances ? kClearanceSteps : 1;
    const uint at = pairHead + gl_SubgroupInvocationID;
    bool keeps = false;
    float low = 0.0;
    uint feature = kNobody;
    uvec4 pair = uvec4(0);
    if (at < pairTail) {
      pair = pairQueue[at % kQueue];
      const PairFrame f = pairFrameOf(pair.w, pair.z, vertexAt(triangleAt(pair.x).x), vertexAt(triangleAt(pair.y).x));
      const PlacedTriangle a = placedA(f, pair.x), b = placedB(f, pair.y);
      const ImpactFloat m = impactOf(a.corners, b.corners, differenceError(a, b));
      low = max(min(m.earliest, m.unknown), 0.0);
      feature = m.feature;
      float bound = limitOf(pair.w, pair.z);
      // A subnormal number might be flushed to 0 later.
      float by = m.ahead ? max(m.by, 1e-37) : kMiss;
      bool isOver = m.latest < 0.0;
      const float clearance = clearanceOf(pair.w);
      if (clearance > 0.0) {
        const WithinClearance within = withinClearance(a, b, clearance, bound);
        // So many pairs may be that near that only the CPU finds the least of them quickly.
        if (within.by == 0.0 || (m.ahead && m.by < 0.0)) atomicOr(states[pair.w].flags, kSearchWithin);
        low = within.low;
        // Pairs whose brackets begin this late do not widen that of the answer (ClearanceContact::consider).
        by = min(by, within.by) * 1.000001 + sensorTexel(pair.w, kTexelFrame + 2).w;
        isOver = false;
      }
      if (by < bound) atomicMin(states[pair.w].hi, floatBitsToUint(by));
      if (m.ahead && m.by < 0.0) atomicMin(states[pair.w].least, pair.z);
      bound = min(bound, by);
      keeps = !isOver && low <= bound;
    }
    keepCandidate(keeps, pair, low, feature);
    pairHead = min(pairHead + kLanes, pairTail);
  }
}

// ------------------------------------------------------------------------------------------------------------------------

void addCount() {
  const uint before = atomicAdd(counts.trianglePairs, trianglePairs);
  if (before + trianglePairs < before) atomicAdd(counts.trianglePairsHigh, 1);
}

void main() {
  if (gl_NumSubgroups != 1) {
    counts.broken = 1;
    return;
  }
  const uint count = counts.rounds[push.round].tasks;
  // Only as many workgroups take part as can spill all their entries.
  const uint room = (push.taskCapacity - count) / ((kStack + 1) * kLanes);
  if (count == 0 || workgroupIndex() >= max(room, 1u)) return;
  const uint budget = count < push.width ? min(push.budget, kSplitBudget) : push.budget;
  leafHead = leafTail = pairHead = pairTail = work = 0;
  tasksLeft = true;
  sensor = object = depth = objectDepth = 0;
  current = uvec3(kNobody, 0, 0);
  limit = scale = unscale = stopBefore = 0.0;
  least = kNobody;
  trianglePairs = 0;
  bool last = false;
  while (!last) {
    bool idle = false;
    do {
      ++work;
      uint named = takeTasks();
      named = shareTasks(named);
      limit = limitOf(states[sensor], stopBefore);
      least = states[sensor].least;
      named = findObjects(named);
      enterObjects(named);
      descend();
      idle = subgroupAll(isIdle()) && !tasksLeft;
      last = idle || work >= budget || subgroupAny(depth + 2 > kStack);
    } while (!last && leafTail - leafHead < kLeafBatch);
    subgroupBarrier();
    do {
      tryLeaves(last);
      subgroupBarrier();
      solvePairs(last);
      subgroupBarrier();
    } while (last && (leafTail != leafHead || pairTail != pairHead));
  }
  spill();
  addCount();
}
