// What each lane of the search has yet to visit, and the tasks from which it comes and which it becomes.

// Entries of a lane, in addition to the current one, that a workgroup sets aside at a time in the list of spilled tasks.
const uint kEntries = 8;

shared SearchTask gifts[kLanes];  // from lanes with several entries to idle lanes

// The same in all lanes.
uint taskCount;  // of this round
bool tasksLeft = true;
uint room;     // in the list of spilled tasks, for all workgroups but the first
uint allowed;  // entries of a lane's stack for which there is room there

// Of a lane.
uint search = 0, object = 0;
float limit = 0.0;                     // contacts beyond this do not count, scaled
uint least = kNobody;                  // SearchState::least: greater objects do not count
uvec3 stack[kStack];                   // a, b, gap of a SearchTask; for the tree over objects: kNobody, link, gap
uint depth = 0, objectDepth = 0;       // entries in use; those of the tree over objects come first
uvec3 current = uvec3(kNobody, 0, 0);  // the pair to test next; none if x is kNobody

bool isIdle() { return current.x == kNobody && depth == 0; }

// Begins a task; returns its object, or kNobody if it is a node of the tree over objects or no longer counts.
uint begin(SearchTask task) {
  search = task.search;
  const SearchState state = states[search];
  if (task.gap > limitOf(search, state) || (task.object != kNobody && task.object > state.least)) return kNobody;
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
  const uint at = first + rankOf(who);
  uint named = kNobody;
  if (idle && tasksLeft && at < taskCount) named = begin(tasks[at]);
  tasksLeft = tasksLeft && first + wanted < taskCount;
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
        SearchTask(search, objectDepth > 0 ? kNobody : object, entry.x, entry.y, uintBitsToFloat(entry.z));
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
      spilled[at] = SearchTask(search, named, entry.x, entry.y, uintBitsToFloat(entry.z));
    } else if (keeps) {
      atomicOr(states[search].flags, kSearchLost);
    }
  }
  return all;
}
