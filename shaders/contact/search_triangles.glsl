// The queues of a workgroup, of pairs of leaves and of triangles, and the tests of what is in them.

// Iterations of the loops within a test of leaves, and of the solution of a pair.
const uint kLeafIterations = 11, kSolveIterations = 27 + kClearanceIterations;

// The same in all lanes: where the queue begins; numbers of entries taken and entered, since the start.
uint leaves, leafHead = 0, leafTail = 0;
uint pairs, pairHead = 0, pairTail = 0;

// Of a lane: how many it has tested.
uint trianglePairs = 0;

void pushLeaves(bool has, uint linkA, uint linkB, float gap) {
  const uvec4 who = subgroupBallot(has);
  if (has) queued[leaves + (leafTail + rankOf(who)) % kQueue] = QueuedPair(uvec4(linkA, linkB, object, search), gap);
  leafTail += subgroupBallotBitCount(who);
}

void pushPair(bool has, uint slotA, uint slotB, uint objectB, uint sensorA, float gap) {
  const uvec4 who = subgroupBallot(has);
  if (has) queued[pairs + (pairTail + rankOf(who)) % kQueue] = QueuedPair(uvec4(slotA, slotB, objectB, sensorA), gap);
  pairTail += subgroupBallotBitCount(who);
}

// What a lane takes from a queue, and what limitOf() was then.
struct Taken {
  bool has;
  QueuedPair entry;
  float limit;
};

// Takes entries that may still count from the head of a queue, one a lane, and drops those before them that do not. `all`: takes
// them even if there are too few for all lanes.
Taken take(uint queue, inout uint head, uint tail, bool all) {
  Taken taken = Taken(false, QueuedPair(uvec4(0), 0.0), 0.0);
  uint missing = kLanes;
  ++work;
  while (missing != 0 && head != tail) {
    ++work;
    const uint at = head + rankOf(subgroupBallot(!taken.has));
    if (!taken.has && at < tail) {
      taken.entry = queued[queue + at % kQueue];
      taken.limit = limitOf(taken.entry.pair.w, taken.entry.pair.z);
      taken.has = taken.entry.gap <= taken.limit;
    }
    head = min(head + missing, tail);
    missing = countOf(!taken.has);
  }
  if (missing != 0 && !all) {
    subgroupBarrier();
    const uvec4 who = subgroupBallot(taken.has);
    head -= subgroupBallotBitCount(who);
    if (taken.has) queued[queue + (head + rankOf(who)) % kQueue] = taken.entry;
    taken.has = false;
  }
  return taken;
}

RADAR_EXCHANGE(PlacedTriangle)

// Tests the pairs of triangles of one pair of leaves a lane, up to two per leaf, and queues those that may meet, the first to meet
// first.
void tryLeaves(bool all) {
  if ((leafTail - leafHead < kLanes && !all) || pairTail - pairHead + 4 * kLanes > kQueue) return;
  const Taken leaf = take(leaves, leafHead, leafTail, all);
  if (countOf(leaf.has) == 0) return;
  work += kLeafIterations;
  countWork(kWorkLeafPair, leaf.has);
  // Of triangle 0 of a and triangles 0 and 1 of b, and of triangle 1 of a.
  vec4 from = vec4(kMiss);
  const uvec4 pair = leaf.entry.pair;
  const uint slotA = pair.x & kLinkItem, slotB = pair.y & kLinkItem;
  if (leaf.has) {
    ++trianglePairs;
    const uint endA = (pair.x & kLinkPair) != 0 ? 1 : 0, endB = (pair.y & kLinkPair) != 0 ? 1 : 0;
    const PairFrame f = pairFrameOf(pair.w, pair.z, vertexAt(triangleAt(slotA).x), vertexAt(triangleAt(slotB).x));
    const float clearance = clearanceOf(pair.w);
    PlacedTriangle a = placedTriangle(f.a, slotA), b = placedTriangle(f.b, slotB), nextA = placedTriangle(f.a, slotA + endA),
                   nextB = placedTriangle(f.b, slotB + endB);
    // One of the triangles changes at a time.
    [[dont_unroll]] for (uint k = 0; k < 4; ++k) {
      const float at = meetsFrom(a, b, clearance, leaf.limit);
      from = mix(from, vec4(at), equal(uvec4(0, 1, 3, 2), uvec4(k)));
      if (k == 1) exchange(a, nextA);
      if (k != 1) exchange(b, nextB);
    }
    if (endA == 0) from.zw = vec2(kMiss);
    if (endB == 0) from.yw = vec2(kMiss);
  }
  [[dont_unroll]] for (uint k = 0; k < 4; ++k) {
    const float next = min(min(from.x, from.y), min(from.z, from.w));
    const uint which = next == from.x ? 0 : next == from.y ? 1 : next == from.z ? 2 : 3;
    pushPair(next < kMiss, slotA + (which >> 1), slotB + (which & 1), pair.z, pair.w, next);
    from = mix(from, vec4(kMiss), equal(uvec4(0, 1, 2, 3), uvec4(which)));
  }
  meet();
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
    const Taken taken = take(pairs, pairHead, pairTail, all);
    if (countOf(taken.has) == 0) break;
    work += kSolveIterations;
    countWork(kWorkSolve, taken.has);
    const uvec4 pair = taken.entry.pair;
    bool keeps = false;
    float low = 0.0;
    uint feature = kNobody;
    if (taken.has) {
      const PairFrame f = pairFrameOf(pair.w, pair.z, vertexAt(triangleAt(pair.x).x), vertexAt(triangleAt(pair.y).x));
      const PlacedTriangle a = placedTriangle(f.a, pair.x), b = placedTriangle(f.b, pair.y);
      const ImpactFloat m = impactOf(a.corners, b.corners, differenceError(a, b));
      low = max(min(firstOf(m), m.unknown), 0.0);
      feature = m.feature;
      float bound = taken.limit;
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
        by = min(by, within.by) * 1.000001 + tolerance(pair.w);
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
  }
}
