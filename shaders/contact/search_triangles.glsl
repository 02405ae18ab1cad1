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

void pushPair(bool has, uint slotA, uint slotB, uint objectB, uint sensorA) {
  const uvec4 who = subgroupBallot(has);
  if (has) queued[pairs + (pairTail + rankOf(who)) % kQueue].pair = uvec4(slotA, slotB, objectB, sensorA);
  pairTail += subgroupBallotBitCount(who);
}

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
        PlacedTriangle a = placedTriangle(f.a, slotA), b = placedTriangle(f.b, slotB), nextA = placedTriangle(f.a, slotA + endA),
                       nextB = placedTriangle(f.b, slotB + endB);
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
      const PlacedTriangle a = placedTriangle(f.a, pair.x), b = placedTriangle(f.b, pair.y);
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
    pairHead = min(pairHead + kLanes, pairTail);
  }
}
