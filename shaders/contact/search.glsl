// The search for first contact. A workgroup is one subgroup. Each lane walks the trees for one sensor: down the tree over
// objects, then down both meshes' trees together, nearest first, with the other nodes on a stack. The lanes share a queue of
// leaf pairs and a queue of triangle pairs that may meet, so that all lanes take part in the expensive tests. When the budget
// ends or a stack is nearly full, pending nodes become tasks of the next round; none is dropped silently.
//
// `work` counts as lavapipe does, which silently ends loops after 65,535 iterations of a subgroup in total: in each loop, also
// that in which it finds that the loop has ended. If it is mistaken, no answer of the submission counts (`loopsEnd`).
//
// All lanes take part in each ballot: lanes that part in a branch meet behind it. What they find out together is the same in all.
// The search notices if that fails, too (`whole`; docs/method.md, "What lanes assume").
//
// search.comp.glsl has no clearances. search_with_clearance.comp.glsl defines RADAR_CLEARANCES, for batches in which a query has
// one: compilers take their time even for what a constant switches off.
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
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
layout(constant_id = 3) const bool kCountsWork = false;

// Other workgroups lower what is here. To have missed that costs time only.
layout(scalar, binding = kSlotStates) coherent restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotTasks) readonly restrict buffer Tasks { SearchTask tasks[]; };
layout(scalar, binding = kSlotSpilled) writeonly restrict buffer Spilled { SearchTask spilled[]; };
layout(scalar, binding = kSlotCandidatePairs) writeonly restrict buffer Candidates { CandidatePair candidates[]; };
// Of each workgroup: its queue of leaf pairs, then its queue of triangle pairs. In memory, since few workgroups would fit on a
// GPU that held them in shared memory.
layout(scalar, binding = kSlotQueuedPairs) coherent restrict buffer Queues { QueuedPair queued[]; };
layout(scalar, binding = kSlotExcluded) readonly restrict buffer Excluded { uint excluded[]; };

layout(push_constant) uniform PushConstants { SearchPush push; };

// A sensor's clearance, scaled, rounded up.
#ifdef RADAR_CLEARANCES
float clearanceOf(uint sensor) { return sensorTexel(sensor, kTexelAcross).w; }
#else
float clearanceOf(uint sensor) { return 0.0; }
#endif

#include "node_pair.glsl"
#include "triangle_pair.glsl"
#ifdef RADAR_CLEARANCES
#include "within_clearance.glsl"
#else
const uint kClearanceIterations = 0;
#endif

// A loop goes on only if at least this many lanes have work in it; otherwise all lanes leave it to fetch work.
const uint kFew = (kLanes + 1) / 2;
// Iterations of a loop over nodes before the queues are checked.
const uint kObjectSteps = 16, kNodeSteps = 24;
// Number of leaf pairs from which on their triangles are tested.
const uint kLeafBatch = kQueue / 4;
// Iterations of the loops within a test of leaves, and of the solution of a pair.
const uint kLeafIterations = 11, kSolveIterations = 27 + kClearanceIterations;
// Entries of a lane, in addition to the current one, that a workgroup sets aside at a time in the list of spilled tasks.
const uint kEntries = 8;
// Budget while there are too few tasks for the device, so that they are soon split into more.
const uint kSplitBudget = 48;

shared SearchTask gifts[kLanes];     // from lanes with several entries to idle lanes

// The same in all lanes.
uint leaves, leafHead, leafTail;     // where the queue begins; numbers of entries taken and entered, since the start
uint pairs, pairHead, pairTail;
uint work;
bool tasksLeft;
uint room;                           // in the list of spilled tasks, for all workgroups but the first
uint allowed;                        // entries of a lane's stack for which there is room there
bool whole;                          // at each meet() all lanes were there

// Of a lane.
uint sensor, object;
float limit;                         // contacts beyond this do not count, scaled
uint least;                          // SearchState::least: greater objects do not count
uvec3 stack[kStack];                 // a, b, gap of a SearchTask; for the tree over objects: kNobody, link, gap
uint depth, objectDepth;             // entries in use; those of the tree over objects come first
uvec3 current;                       // the pair to test next; none if x is kNobody
MeshPair meshes;
const MeshPair kNoMeshes = MeshPair(mat3(0.0), mat3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0),
                                    vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, false);
uint trianglePairs;
uint done[kWorks], steps[kWorks];    // see SearchCounts

void countWork(uint what, bool does) {
  if (!kCountsWork) return;
  done[what] += uint(does);
  ++steps[what];
}

uint countOf(bool has) { return subgroupBallotBitCount(subgroupBallot(has)); }
void meet() { whole = whole && countOf(true) == kLanes; }
uint rankOf(uvec4 ballot) { return subgroupBallotExclusiveBitCount(ballot); }

// Contacts beyond this do not count. It is negative, which ends the search, if an `anyHit` query has a certain contact or the
// search has failed.
float limitOf(uint s, SearchState state) {
  const float hi = uintBitsToFloat(state.hi);
  return hi < sensorTexel(s, kTexelHalfExtent).w || state.flags != 0 ? -1.0 : hi;
}

// The limit for an object. If a lesser object certainly meets at the start, this one cannot be the answer.
float limitOf(uint s, uint objectB) {
  const SearchState state = states[s];
  return objectB > state.least ? -1.0 : limitOf(s, state);
}

void pushLeaves(bool has, uint linkA, uint linkB, float gap) {
  const uvec4 who = subgroupBallot(has);
  if (has) queued[leaves + (leafTail + rankOf(who)) % kQueue] = QueuedPair(uvec4(linkA, linkB, object, sensor), gap);
  leafTail += subgroupBallotBitCount(who);
}

void pushPair(bool has, uint slotA, uint slotB, uint objectB, uint sensorA) {
  const uvec4 who = subgroupBallot(has);
  if (has) queued[pairs + (pairTail + rankOf(who)) % kQueue].pair = uvec4(slotA, slotB, objectB, sensorA);
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

// Begins a task; returns its object, or kNobody if it is a node of the tree over objects or no longer counts.
uint begin(SearchTask task) {
  sensor = task.sensor;
  const SearchState state = states[sensor];
  if (task.gap > limitOf(sensor, state) || (task.object != kNobody && task.object > state.least)) return kNobody;
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

// Sets room aside for tasks that the lanes may spill, as many of each. Returns whether there was enough.
bool setAside(uint perLane) {
  const uint wanted = perLane * kLanes;
  uint before = 0;
  if (subgroupElect()) before = atomicAdd(counts.rounds[push.round].aside, wanted);
  before = subgroupBroadcastFirst(before);
  const bool fits = before + wanted <= room;
  if (!fits && subgroupElect()) atomicAdd(counts.rounds[push.round].aside, 0u - wanted);
  return fits;
}

// Whether all stacks have room for what a step may push; sets more aside if they are nearly full.
bool stacksHaveRoom() {
  ++work;
  while (subgroupAny(depth + 2 > allowed)) {
    ++work;
    const uint more = min(kEntries, kStack - allowed);
    if (more == 0 || !setAside(more)) return false;
    allowed += more;
  }
  return true;
}

// Turns pending entries into tasks of the next round; returns how many.
uint spill() {
  uint all = 0;
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
    all += subgroupBallotBitCount(who);
    if (subgroupElect()) first = atomicAdd(counts.rounds[push.round].spilled, subgroupBallotBitCount(who));
    first = subgroupBroadcastFirst(first);
    const uint at = first + rankOf(who);
    meet();
    if (keeps && at < push.taskCapacity) {
      spilled[at] = SearchTask(sensor, named, entry.x, entry.y, uintBitsToFloat(entry.z));
    } else if (keeps) {
      atomicOr(states[sensor].flags, kSearchLost);
    }
  }
  return all;
}

// ---- nodes -------------------------------------------------------------------------------------------------------------

// Lanes without an object walk the tree over objects until they find one.
uint findObjects(uint named) {
  ++work;
  const SensorBox box = sensorBoxOf(sensor);
  const float scale = sensorTexel(sensor, kTexelDirection).w, most = limit * sensorTexel(sensor, kTexelMask).w;
  for (uint step = 0; step < kObjectSteps; ++step) {
    const bool searching =
        named == kNobody && current.x == kNobody && depth > 0 && depth == objectDepth && depth < allowed;
    const uint count = countOf(searching);
    if (count == 0 || (count < kFew && step > 0)) break;
    ++work;
    countWork(kWorkObjectNode, searching);
    if (searching) {
      const uvec3 entry = stack[--depth];
      const bool near = uintBitsToFloat(entry.z) <= limit, leaf = isLeaf(entry.y);
      if (near && leaf && (entry.y & kLinkItem) <= least) named = entry.y & kLinkItem;
      const int t = near && !leaf ? int(2 * entry.y) : 0;
      const uvec4 x0 = texelFetch(objectNodeTexels, t), x1 = texelFetch(objectNodeTexels, t + 2);
      const vec2 at0 = meetsBox(box, uintBitsToFloat(x0), uintBitsToFloat(texelFetch(objectNodeTexels, t + 1))),
                 at1 = meetsBox(box, uintBitsToFloat(x1), uintBitsToFloat(texelFetch(objectNodeTexels, t + 3)));
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
  ++work;
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

// Lanes with a new object begin at its root, or at the nodes of their task (`current`). `resumes`: lanes have forgotten what
// they know of the object that they are in.
void enterObjects(uint named, bool resumes) {
  ++work;
  // All lanes run the loop over excluded objects.
  const bool enters = isEligible(named == kNobody ? 0 : named) && named != kNobody;
  if (enters) object = named;
  const bool places = enters || (resumes && (current.x != kNobody || depth > objectDepth));
  countWork(kWorkObject, places);
  if (places) {
    meshes = meshPairOf(sensor, object);
    if (!meshes.inRange) {
      atomicOr(states[sensor].flags, kSearchOutOfRange);
      current.x = kNobody;
    } else if (enters && current.x == kNobody) {
      current = uvec3(sensorBits(sensor, kTexelReach).w | kLinkPair, objectBits(object, kTexelReach).w, 0);
    }
  }
}

// Descends both meshes' trees: tests the two children of one node with the other node, or two roots with each other.
void descend() {
  ++work;
  // Whether lanes without work could find some after the loop.
  const bool more = countOf(current.x == kNobody && (depth > 0 || tasksLeft)) != 0;
  for (uint step = 0; step < kNodeSteps; ++step) {
    if (current.x == kNobody && depth > objectDepth) current = stack[--depth];
    const bool tries = current.x != kNobody && depth < allowed;
    const uint count = countOf(tries);
    if (count == 0 || leafTail - leafHead + 2 * kLanes > kQueue || (count < kFew && step > 0 && more)) break;
    work += 4;
    const bool near = tries && uintBitsToFloat(current.z) <= limit && object <= least;
    const bool intoA = isLeaf(current.x), areRoots = (current.x & kLinkPair) != 0;
    uvec3 nearest = uvec3(kNobody, 0, 0), other = nearest;
    [[dont_unroll]] for (uint child = 0; child < 2; ++child) {
      bool leaves = false;
      uint linkA = 0, linkB = 0;
      float gap = 0.0;
      const bool tests = near && (child == 0 || !areRoots);
      countWork(kWorkNodePair, tests);
      if (tests) {
        const uint ia = (current.x & kLinkItem) + (intoA ? child : 0), ib = current.y + (intoA ? 0 : child);
        const Node a = nodeAt(ia), b = nodeAt(ib);
        const Approach approach = approachOf(meshes, a, b, limit);
        linkA = a.link;
        linkB = b.link;
        gap = approach.gap;
        leaves = gap < kMiss && isLeaf(linkA & linkB);
        if (gap < kMiss && !leaves) {
          const uvec3 entry = entryOf(ia, a, ib, b, approach);
          const bool first = nearest.x == kNobody || gap < uintBitsToFloat(nearest.z);
          other = first ? nearest : entry;
          nearest = first ? entry : nearest;
        }
      }
      pushLeaves(leaves, linkA, linkB, gap);
    }
    meet();
    if (other.x != kNobody) stack[depth++] = other;
    if (tries) current = nearest;
  }
}

// ---- triangles ---------------------------------------------------------------------------------------------------------

RADAR_EXCHANGE(PlacedTriangle)

// Tests the pairs of triangles, up to two per leaf, and queues those that may meet. `all`: until no leaf is left.
void tryLeaves(bool all) {
  while ((leafTail - leafHead >= kLanes || (all && leafTail != leafHead)) && pairTail - pairHead + 4 * kLanes <= kQueue) {
    work += kLeafIterations;
    const uint at = leafHead + gl_SubgroupInvocationID;
    countWork(kWorkLeafPair, at < leafTail);
    uint meets = 0;  // bit 2 i + j: triangle i of a may meet triangle j of b
    uvec4 leaf = uvec4(0);
    if (at < leafTail) {
      leaf = queued[leaves + at % kQueue].pair;
      const float bound = limitOf(leaf.w, leaf.z);
      if (queued[leaves + at % kQueue].gap <= bound) {
        ++trianglePairs;
        const uint slotA = leaf.x & kLinkItem, slotB = leaf.y & kLinkItem;
        const uint endA = (leaf.x & kLinkPair) != 0 ? 1 : 0, endB = (leaf.y & kLinkPair) != 0 ? 1 : 0;
        const PairFrame f = pairFrameOf(leaf.w, leaf.z, vertexAt(triangleAt(slotA).x), vertexAt(triangleAt(slotB).x));
        const float clearance = clearanceOf(leaf.w);
        PlacedTriangle a = placedA(f, slotA), b = placedB(f, slotB), nextA = placedA(f, slotA + endA),
                       nextB = placedB(f, slotB + endB);
        // One of the triangles changes at a time.
        [[dont_unroll]] for (uint k = 0; k < 4; ++k) {
          if (mayMeet(a, b, clearance, bound)) meets |= 1u << (k ^ k >> 1);
          if (k == 1) exchange(a, nextA);
          if (k != 1) exchange(b, nextB);
        }
        if (endA == 0) meets &= 3;
        if (endB == 0) meets &= 5;
      }
    }
    [[dont_unroll]] for (uint k = 0; k < 4; ++k) {
      pushPair((meets >> k & 1) != 0, (leaf.x & kLinkItem) + (k >> 1), (leaf.y & kLinkItem) + (k & 1), leaf.z, leaf.w);
    }
    meet();
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
    work += kSolveIterations;
    const uint at = pairHead + gl_SubgroupInvocationID;
    countWork(kWorkSolve, at < pairTail);
    bool keeps = false;
    float low = 0.0;
    uint feature = kNobody;
    uvec4 pair = uvec4(0);
    if (at < pairTail) {
      pair = queued[pairs + at % kQueue].pair;
      const PairFrame f = pairFrameOf(pair.w, pair.z, vertexAt(triangleAt(pair.x).x), vertexAt(triangleAt(pair.y).x));
      const PlacedTriangle a = placedA(f, pair.x), b = placedB(f, pair.y);
      const ImpactFloat m = impactOf(a.corners, b.corners, differenceError(a, b));
      low = max(min(firstOf(m), m.unknown), 0.0);
      feature = m.feature;
      float bound = limitOf(pair.w, pair.z);
      // A subnormal number might be flushed to 0 later.
      float by = m.ahead ? max(lastOf(m), 1e-37) : kMiss;
      bool isOver = m.isOver;
#ifdef RADAR_CLEARANCES
      const float clearance = clearanceOf(pair.w);
      if (clearance > 0.0) {
        const WithinClearance within = withinClearance(a, b, clearance, bound);
        // So many pairs may be that near that only the CPU finds the least of them quickly.
        if (within.by == 0.0 || (m.ahead && lastOf(m) < 0.0)) atomicOr(states[pair.w].flags, kSearchWithin);
        low = within.low;
        // Pairs whose brackets begin this late do not widen that of the answer (ClearanceContact::consider).
        by = min(by, within.by) * 1.000001 + sensorTexel(pair.w, kTexelAlong).w;
        isOver = false;
      }
#endif
      if (by < bound) atomicMin(states[pair.w].hi, floatBitsToUint(by));
      if (m.ahead && lastOf(m) < 0.0) atomicMin(states[pair.w].least, pair.z);
      bound = min(bound, by);
      keeps = !isOver && low <= bound;
    }
    meet();
    keepCandidate(keeps, pair, low, feature);
    pairHead = min(pairHead + kLanes, pairTail);
  }
}

// ------------------------------------------------------------------------------------------------------------------------

// Whether the driver has run all loops to their ends. The number is hidden from compilers.
bool loopsEnd() {
  uint turns = 0;
  while (turns < gl_NumWorkGroups.z + 2) ++turns;
  return turns == gl_NumWorkGroups.z + 2;
}

void addCount() {
  const uint before = atomicAdd(counts.trianglePairs, trianglePairs);
  if (before + trianglePairs < before) atomicAdd(counts.trianglePairsHigh, 1);
  for (uint what = 0; kCountsWork && what < kWorks; ++what) {
    atomicAdd(counts.done[what], done[what]);
    atomicAdd(counts.steps[what], steps[what]);
  }
}

void main() {
  if (gl_NumSubgroups != 1) {
    counts.broken = kBrokenSubgroups;
    return;
  }
  const uint count = counts.rounds[push.round].tasks;
  if (workgroupIndex() * kLanes >= count) return;
  // A workgroup goes on only while there is room for all that it may have to spill. The first one always has its own.
  const bool isFirst = workgroupIndex() == 0;
  const uint most = (kStack + 1) * kLanes;
  room = max(push.taskCapacity - count, most) - most;
  allowed = isFirst ? kStack : min(kStack, kEntries);
  if (!isFirst && !setAside(allowed + 1)) return;
  const uint budget = count < push.width ? min(push.budget, kSplitBudget) : push.budget;
  leaves = 2 * kQueue * workgroupIndex();
  pairs = leaves + kQueue;
  leafHead = leafTail = pairHead = pairTail = work = 0;
  tasksLeft = whole = true;
  sensor = object = depth = objectDepth = 0;
  current = uvec3(kNobody, 0, 0);
  limit = 0.0;
  least = kNobody;
  trianglePairs = 0;
  for (uint what = 0; kCountsWork && what < kWorks; ++what) done[what] = steps[what] = 0;
  bool last = false;
  while (!last) {
    bool idle = false, resumes = true;
    meshes = kNoMeshes;
    do {
      ++work;
      uint named = takeTasks();
      named = shareTasks(named);
      const SearchState state = states[sensor];
      limit = limitOf(sensor, state);
      least = state.least;
      named = findObjects(named);
      enterObjects(named, resumes);
      resumes = false;
      descend();
      meet();
      idle = subgroupAll(isIdle()) && !tasksLeft;
      last = idle || work >= budget || !stacksHaveRoom();
    } while (!last && leafTail - leafHead < kLeafBatch);
    subgroupBarrier();
    do {
      tryLeaves(last);
      subgroupBarrier();
      solvePairs(last);
      subgroupBarrier();
    } while (last && (leafTail != leafHead || pairTail != pairHead));
  }
  const uint spilledNow = spill();
  if (!isFirst && subgroupElect()) {
    atomicAdd(counts.rounds[push.round].aside, spilledNow - (allowed + 1) * kLanes);
  }
  addCount();
  if (!loopsEnd()) counts.broken = kBrokenLoops;
  if (!whole || !subgroupAllEqual(uvec3(leafTail, pairTail, work))) counts.broken = kBrokenLanes;
}
