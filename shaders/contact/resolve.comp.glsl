// Decides the answers, one invocation per sensor. If the device is certain which features touch first, it leaves the numbers to
// describe.comp; of an overlap, it gives all but the point. Otherwise it lists the pairs that may be first as unresolved, for the
// CPU to decide. A device without doubles lists all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "answers.glsl"

uint described = kNobody;  // the refined pair whose contact is the answer

#ifndef RADAR_NO_DOUBLES
// 0: vertex on face, 1: face on vertex, 2: edge on edge.
uint kindOf(uint feature) { return feature < 3 ? 0 : feature < kFeatureEdges ? 1 : 2; }

// Which corners of one of the triangles a feature joins, sorted; if fewer than three, the last repeated.
uvec3 cornersIn(uint feature, bool ofA) {
  if (feature >= kFeatureEdges) {
    const uint edge = ofA ? (feature - kFeatureEdges) / 3 : (feature - kFeatureEdges) % 3, end = edge == 0 ? 1 : 2;
    return uvec3(edge == 1 ? 1 : 0, end, end);
  }
  return ofA == feature < 3 ? uvec3(feature % 3) : uvec3(0, 1, 2);
}

// Whether the certain features of all pairs that may be first join the points that those of `one` do. All are of one kind.
bool joinSamePoints(PairSummary pairs, uint one) {
  bool same = true;
  [[dont_unroll]] for (uint side = 0; side < 2; ++side) {
    dvec3 p[3];
    uint i = one;
    for (bool first = true; i != kNobody && same; first = false) {
      const RefinedPair c = refinedPairs[i];
      if (c.low <= pairs.limit) {
        const uvec3 which = cornersIn(c.flags & 0xffu, side == 0);
        dvec3 q[3];
        cornersOf(c, side == 0, q);
        q = dvec3[3](picked(q, which.x), picked(q, which.y), picked(q, which.z));
        if (first) p = q;
        same = p == q;
      }
      i = first ? heads[s] : c.next;
    }
  }
  return same;
}

// What the corners of a triangle are, sorted: a point is a vertex, and a segment an edge.
uint wholeOf(dvec3 p[3]) {
  if (p[0] == p[2]) return RADAR_FEATURE_vertex;
  return p[0] == p[1] || p[1] == p[2] ? RADAR_FEATURE_edge : RADAR_FEATURE_face;
}

// Sets the refined pair's overlap, and lists the pair, for the CPU to find the point. Returns whether there was room.
bool setOverlap(RefinedPair c, inout RadarResult r) {
  r.status = RADAR_STATUS_overlap;
  // The contact certainly begins before the start and ends after it.
  [[dont_unroll]] for (uint side = 0; side < 2; ++side) {
    dvec3 p[3];
    cornersOf(c, side == 0, p);
    r.featureA = r.featureB;
    r.featureB = wholeOf(p);
  }
  r.t = r.lo = r.hi = r.fraction = r.gap = uvec2(0);
  const uint at = reserveUnresolved(1);
  if (at != kNobody) writeUnresolved(at, c);
  return at != kNobody;
}

// Sets the answer if it is certain, or leaves it to describe.comp; else returns false. It is certain if all pairs that may be
// first certainly begin at the same features; or if a pair certainly meets at the start, and every pair of a lesser name that may
// be first does, too.
bool setCertainAnswer(PairSummary pairs, inout RadarResult r) {
  if (pairs.count > kMostCompared || sweeps[s].anyHit != 0) return false;
  const bool pierces = pairs.pierced.w != kNobody;
  const uvec4 winner = pierces ? pairs.pierced : pairs.least;
  const RefinedPair one = refinedPairs[winner.w];
  bool certain = pierces || (one.flags & kPairSharp) != 0;
  for (uint i = heads[s]; i != kNobody && certain; i = refinedPairs[i].next) {
    const RefinedPair c = refinedPairs[i];
    if (c.low > pairs.limit) continue;
    if (pierces) {
      certain = (c.flags & kPairPierces) != 0 || !isLess(nameOf(c), winner.xyz);
    } else {
      certain = (c.flags & kPairSharp) != 0 && c.at == one.at && kindOf(c.flags & 0xffu) == kindOf(one.flags & 0xffu);
    }
  }
  if (!certain || (!pierces && pairs.possible > 1 && !joinSamePoints(pairs, winner.w))) return false;
  if (!pierces) {
    described = winner.w;
    return true;
  }
  r.detected = RADAR_DETECTED_yes;
  r.object = winner.x;
  r.triB = winner.y;
  r.triA = winner.z;
  return setOverlap(one, r);
}

RadarResult decide(SearchState state, bool met) {
  if (sweeps[s].cpuDecides != 0) return leaveAll(met);
  const PairSummary pairs = summarise(hiOf(state));
  if (pairs.least.w == kNobody) return noContact(met);
  if (pairs.count == kMostListed) return invalid(RADAR_FLAG_candidates);
  RadarResult r = nothing(RADAR_STATUS_hit, kNoNumber);
  return setCertainAnswer(pairs, r) ? r : leaveThese(pairs, met);
}
#else
RadarResult decide(SearchState state, bool met) { return leaveAll(met); }
#endif

RadarResult answer(SearchState state) {
  if (sweeps[s].anyHit != 0 && hasMet(state)) return within();
  return decide(state, hasMet(state));
}

void main() {
  s = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (s >= push.sensors) return;
  const SearchState state = states[s];
  const uint missing = ((state.flags & kSearchLost) != 0 ? RADAR_FLAG_candidates : 0) |
                       ((state.flags & kSearchUnfinished) != 0 || counts.broken != 0 ? RADAR_FLAG_rounds : 0) |
                       ((state.flags & kSearchOutOfRange) != 0 ? RADAR_FLAG_range : 0) |
                       ((state.flags & kSearchNoQuery) != 0 ? RADAR_FLAG_query : 0);
  RadarResult r;
  if ((state.flags & kSearchWithin) != 0) {
    r = withinAtStart();
  } else if (missing != 0) {
    r = invalid(missing);
  } else {
    r = answer(state);
  }
  if (described == kNobody) results[sweeps[s].result] = r;
  if (heads[s] != kNobody) refinedPairs[heads[s]].left = described;
}
