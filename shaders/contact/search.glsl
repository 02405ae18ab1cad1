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
// Iterations of a loop over nodes before the queues are checked.
layout(constant_id = 4) const uint kObjectSteps = 16;
layout(constant_id = 5) const uint kNodeSteps = 24;
// A loop goes on only if at least this many lanes have work in it; otherwise all lanes leave it to fetch work. Half as many go on
// looking for objects: a step takes a quarter of the instructions with which all lanes wait while some enter theirs.
layout(constant_id = 6) const uint kFew = 16;
// Number of leaf pairs from which on their triangles are tested.
layout(constant_id = 7) const uint kLeafBatch = 64;
// Budget while there are too few tasks for the device, so that they are soon split into more.
layout(constant_id = 8) const uint kSplitBudget = 48;

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
float clearanceOf(uint search) { return statedClearance(search); }
#else
float clearanceOf(uint search) { return 0.0; }
#endif

#include "node_pair.glsl"
#include "triangle_pair.glsl"
#ifdef RADAR_CLEARANCES
#include "reach.glsl"
#include "within_clearance.glsl"
#else
const uint kClearanceIterations = 0;
#endif

// The same in all lanes.
uint work = 0;
bool whole = true;                 // at each meet() all lanes were there

// Of a lane.
uint done[kWorks], steps[kWorks];  // see SearchCounts

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
  return hi < stopBefore(s) || state.flags != 0 ? -1.0 : hi;
}

// The limit for an object. If a lesser object certainly meets at the start, this one cannot be the answer.
float limitOf(uint s, uint objectB) {
  const SearchState state = states[s];
  return objectB > state.least ? -1.0 : limitOf(s, state);
}

#include "search_tasks.glsl"
#include "search_triangles.glsl"
#include "search_nodes.glsl"

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
  taskCount = counts.rounds[push.round].tasks;
  if (workgroupIndex() * kLanes >= taskCount) return;
  // A workgroup goes on only while there is room for all that it may have to spill. The first one always has its own.
  const bool isFirst = workgroupIndex() == 0;
  const uint most = (kStack + 1) * kLanes;
  room = max(push.taskCapacity - taskCount, most) - most;
  allowed = isFirst ? kStack : min(kStack, kEntries);
  if (!isFirst && !setAside(allowed + 1)) return;
  const uint budget = taskCount < push.width ? min(push.budget, kSplitBudget) : push.budget;
  leaves = 2 * kQueue * workgroupIndex();
  pairs = leaves + kQueue;
  for (uint what = 0; kCountsWork && what < kWorks; ++what) done[what] = steps[what] = 0;
  bool last = false;
  while (!last) {
    bool idle = false, resumes = true;
    meshes = kNoMeshes;
    do {
      ++work;
      uint named = takeTasks();
      named = shareTasks(named);
      const SearchState state = states[search];
      limit = limitOf(search, state);
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
      solvePairs(last && leafTail == leafHead);
      subgroupBarrier();
    } while (leafTail - leafHead >= kLanes || (last && (leafTail != leafHead || pairTail != pairHead)));
  }
  const uint spilledNow = spill();
  if (!isFirst && subgroupElect()) {
    atomicAdd(counts.rounds[push.round].aside, spilledNow - (allowed + 1) * kLanes);
  }
  addCount();
  if (!loopsEnd()) counts.broken = kBrokenLoops;
  if (!whole || !subgroupAllEqual(uvec3(leafTail, pairTail, work))) counts.broken = kBrokenLanes;
}
