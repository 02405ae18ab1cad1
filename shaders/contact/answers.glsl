// What resolve.comp and describe.comp share: the forms of answers, and the lists of a sensor's refined pairs and of what is left
// to the CPU.
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#include "interop.h"
#include "shared/scene.glsl"
#define RADAR_RESULT_BITS
#include "radar/result.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) readonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotHeads) readonly restrict buffer Heads { uint heads[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
layout(scalar, binding = kSlotSweeps) readonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotResults) writeonly restrict buffer Results { RadarResult results[]; };
layout(scalar, binding = kSlotUnresolved) writeonly restrict buffer Unresolved { UnresolvedPair unresolved[]; };

layout(push_constant) uniform PushConstants { ResolvePush push; };

// Lavapipe ends loops silently after 65,535 iterations of a subgroup: longer lists are not compared but listed, and lists
// longer than kMostListed are given up.
const uint kMostCompared = 1024;
const uint kMostListed = 16384;

uint s;

// Ties are broken by this.
uvec3 nameOf(RefinedPair c) { return uvec3(c.object, triangleAt(c.slotB).w, triangleAt(c.slotA).w); }
bool isLess(uvec3 p, uvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

vec3[3] cornersAt(uint slot) {
  const uvec4 corner = triangleAt(slot);
  return vec3[3](vertexAt(corner.x), vertexAt(corner.y), vertexAt(corner.z));
}

// Reserves entries for unresolved pairs and returns the first. If they do not fit, marks the remaining entries unused and
// returns kNobody.
uint reserveUnresolved(uint pairs) {
  // The sum cannot wrap: it is at most twice the number of refined pairs.
  const uint at = atomicAdd(counts.unresolved, pairs), end = at + pairs;
  if (end <= push.unresolvedCapacity) return at;
  for (uint i = at; i < push.unresolvedCapacity; ++i) unresolved[i].search = kNobody;
  return kNobody;
}

void writeUnresolved(uint at, RefinedPair c) {
  const uvec3 name = nameOf(c);
  unresolved[at] =
      UnresolvedPair(s, name.x, name.y, name.z, objects[c.object].mesh, 0, cornersAt(c.slotA), cornersAt(c.slotB), objects[c.object].pose);
}

#include "shared/double_bits.glsl"
// x / scale, a power of two, by the exponent.
uvec2 unscaled(float x, float scale) {
  const uvec2 bits = doubleBits(floatBitsToUint(x));
  const int shift = int(floatBitsToUint(scale) >> 23) - 127;
  return x == 0.0 ? uvec2(0) : uvec2(bits.x, uint(int(bits.y) - (shift << 20)));
}

#ifndef RADAR_NO_DOUBLES
#include "shared/bounded.glsl"
#include "shared/divide.glsl"
// 0 is written without sign: Vulkan does not define the sign of 0.
uvec2 bitsOf(double x) { return x == 0.0LF ? uvec2(0) : unpackDouble2x32(x); }
uvec2[3] bitsOf(dvec3 v) { return uvec2[3](bitsOf(v.x), bitsOf(v.y), bitsOf(v.z)); }
double hiOf(SearchState state) { return quotient(double(uintBitsToFloat(state.hi)), double(sweeps[s].scale)); }
#else
uvec2 bitsOf(uvec2 x) { return x; }
#endif

// Compares the bits of non-negative doubles.
bool isAbove(uvec2 p, uvec2 q) { return p.y > q.y || (p.y == q.y && p.x > q.x); }

const uvec2 kNoNumber = uvec2(0, 0x7ff80000u), kOne = uvec2(0, 0x3ff00000u);

// A result without a contact, with `distances` in place of all of them.
RadarResult nothing(uint status, uvec2 distances) {
  const uvec2 n = kNoNumber;
  return RadarResult(status, RADAR_TIER_contact, RADAR_DETECTED_notLooked, 0, distances, distances, distances, distances,
                     kNobody, kNobody, kNobody, 0, RADAR_FEATURE_none, RADAR_FEATURE_none, uvec2[3](n, n, n), uvec2[3](n, n, n), n, n);
}
RadarResult free(uint status) { return nothing(status, uvec2(0, 0x7ff00000u)); }

RadarResult invalid(uint flags) {
  RadarResult r = nothing(RADAR_STATUS_invalid, kNoNumber);
  r.flags = flags;
  return r;
}

// No pair is left: the answer is clear, unless the search found a certain contact.
RadarResult noContact(bool met) { return met ? invalid(0) : free(RADAR_STATUS_clear); }

// The answer to an `anyHit` query: the same bits, whichever contact was found.
RadarResult within() {
  RadarResult r = nothing(RADAR_STATUS_hit, kNoNumber);
  r.detected = RADAR_DETECTED_yes;
  r.lo = uvec2(0);
  r.t = r.hi = bitsOf(sweeps[s].distance);
  r.fraction = r.hi == uvec2(0) ? r.hi : kOne;
  return r;
}

// Within the clearance at the start. Which pair of triangles is the least of those is not searched for.
RadarResult withinAtStart() {
  if (sweeps[s].anyHit != 0) return within();
  RadarResult r = nothing(RADAR_STATUS_overlap, kNoNumber);
  r.detected = RADAR_DETECTED_yes;
  r.t = r.lo = r.hi = r.fraction = uvec2(0);
  return r;
}

// `low`: world units. `lowOfStep`: the same, scaled.
RadarResult undecided(bool met, uvec2 low, float lowOfStep) {
  RadarResult r = free(RADAR_STATUS_undecided);
  r.flags = RADAR_FLAG_unresolved;
  if (met) r.detected = RADAR_DETECTED_yes;
  const float perUnit = sweeps[s].stepPerUnit;
  if (perUnit != 0.0) low = doubleBits(floatBitsToUint(max(lowOfStep * perUnit, 0.0)));
  const uvec2 distance = bitsOf(sweeps[s].distance);
  r.lo = isAbove(low, distance) ? distance : low;
  // Whoever takes t for free way is right.
  r.t = r.lo;
  r.fraction = kNoNumber;
  return r;
}

// Lists all pairs as unresolved. The list has only pairs that begin no later than `hi` (link.comp).
RadarResult leaveAll(bool met) {
  if (heads[s] == kNobody) return noContact(met);
  float low = 3.0e38;
  uint count = 0;
  for (uint i = heads[s]; i != kNobody && count < kMostListed; i = refinedPairs[i].next, ++count) {
    low = min(low, refinedPairs[i].first);
  }
  if (count == kMostListed) return invalid(RADAR_FLAG_candidates);
  uint at = reserveUnresolved(count);
  for (uint i = heads[s]; i != kNobody && at != kNobody; i = refinedPairs[i].next) writeUnresolved(at++, refinedPairs[i]);
  return undecided(met, unscaled(low, sweeps[s].scale), low);
}

#ifndef RADAR_NO_DOUBLES
// A summary of a sensor's refined pairs.
struct PairSummary {
  uint count;            // number of refined pairs
  double limit;          // a pair that begins beyond this is not first
  double low;            // no contact before this
  uint possible;         // number of pairs that may be first
  // Least name and its refined pair: of those that may be first; of those that also certainly meet; that certainly meet at the
  // start.
  uvec4 least, meets, pierced;
  double end;            // those that certainly meet do so by this
};

PairSummary summarise(double hi) {
  const uint first = heads[s];
  const double length = sweeps[s].directionLength;
  PairSummary pairs = PairSummary(0, hi, kNever, 0, uvec4(kNobody), uvec4(kNobody), uvec4(kNobody), kNever);
  for (uint i = first; i != kNobody && pairs.count < kMostListed; i = refinedPairs[i].next) {
    const RefinedPair c = refinedPairs[i];
    if ((c.flags & kPairMeets) != 0) pairs.end = min(pairs.end, max(c.at + c.error, 0.0LF) * length * (1.0LF + kRounded));
    ++pairs.count;
  }
  pairs.limit = min(pairs.limit, pairs.end);
  for (uint i = first, k = 0; k < pairs.count; i = refinedPairs[i].next, ++k) {
    const RefinedPair c = refinedPairs[i];
    if (c.low > pairs.limit) continue;
    pairs.low = min(pairs.low, c.low);
    ++pairs.possible;
    const uvec3 name = nameOf(c);
    if (isLess(name, pairs.least.xyz)) pairs.least = uvec4(name, i);
    if ((c.flags & kPairMeets) != 0 && isLess(name, pairs.meets.xyz)) pairs.meets = uvec4(name, i);
    if ((c.flags & kPairPierces) != 0 && isLess(name, pairs.pierced.xyz)) pairs.pierced = uvec4(name, i);
  }
  return pairs;
}

// Lists the pairs that may be first. If one of them certainly meets before the end, the answer is a hit, with a bracket.
RadarResult leaveThese(PairSummary pairs, bool met) {
  uint at = reserveUnresolved(pairs.possible);
  for (uint i = heads[s]; i != kNobody && at != kNobody; i = refinedPairs[i].next) {
    if (refinedPairs[i].low <= pairs.limit) writeUnresolved(at++, refinedPairs[i]);
  }
  const double distance = sweeps[s].distance, perLength = quotient(sweeps[s].perParameter, sweeps[s].directionLength);
  const double below = pairs.low * perLength * (1.0LF - kRounded), above = pairs.end * perLength * (1.0LF + kRounded);
  if (pairs.meets.w == kNobody || below <= 0.0LF || above * (1.0LF + kRounded) >= distance || sweeps[s].anyHit != 0) {
    return undecided(met, bitsOf(pairs.low), float(min(pairs.low * double(sweeps[s].scale), 1e30LF)));
  }
  RadarResult r = nothing(RADAR_STATUS_hit, kNoNumber);
  r.flags = RADAR_FLAG_unresolved;
  r.detected = RADAR_DETECTED_yes;
  r.object = pairs.meets.x;
  r.triB = pairs.meets.y;
  r.triA = pairs.meets.z;
  r.t = r.lo = bitsOf(below);
  r.hi = bitsOf(above);
  r.fraction = bitsOf(quotient(below, distance));
  return r;
}

#include "placed_corners.glsl"
// Sorted corners of one of a refined pair's triangles: the sensor's if `ofA`, else the scene's.
void cornersOf(RefinedPair c, bool ofA, out dvec3 corners[3]) {
  if (ofA) {
    placedCorners(sweeps[s].pose, c.slotA, corners);
  } else {
    placedCorners(objects[c.object].pose, c.slotB, corners);
  }
}
#endif

bool hasMet(SearchState state) { return uintBitsToFloat(state.hi) < sweeps[s].start; }
