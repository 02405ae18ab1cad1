// What a search has met becomes an answer, an invocation for each sensor. Where the device is certain which features touch
// first, it tells the numbers, in the arithmetic of engine/exact and with its bits; else it lists the pairs that may be
// first, with what the host needs to decide them. On a device without doubles that is all that may be first.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "shared/scene.glsl"
#define RADAR_RESULT_BITS
#include "radar/result.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) readonly restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotHeads) readonly restrict buffer Heads { uint heads[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) readonly restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
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

// Ties go by this.
uvec3 nameOf(RefinedPair c) { return uvec3(c.object, triangleAt(c.slotB).w, triangleAt(c.slotA).w); }
bool isLess(uvec3 p, uvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

vec3[3] cornersAt(uint slot) {
  const uvec4 corner = triangleAt(slot);
  return vec3[3](vertexAt(corner.x), vertexAt(corner.y), vertexAt(corner.z));
}

// Takes room for so many pairs, or none: then what is left of it is marked as nobody's.
uint roomFor(uint pairs) {
  const uint before = atomicOr(counts.unresolved, 0);
  if (before >= push.unresolvedCapacity) return kNobody;
  const uint at = atomicAdd(counts.unresolved, pairs), end = at + pairs;
  if (end <= push.unresolvedCapacity) return at;
  for (uint i = at; i < push.unresolvedCapacity; ++i) unresolved[i].sensor = kNobody;
  return kNobody;
}

void list(uint at, RefinedPair c) {
  const uvec3 name = nameOf(c);
  unresolved[at] =
      UnresolvedPair(s, name.x, name.y, name.z, cornersAt(c.slotA), cornersAt(c.slotB), objects[c.object].pose);
}

#ifndef RADAR_NO_DOUBLES
#include "shared/divide.glsl"
// 0 has no sign: what a device makes of it is its own.
uvec2 bitsOf(double x) { return x == 0.0LF ? uvec2(0) : unpackDouble2x32(x); }
uvec2[3] bitsOf(dvec3 v) { return uvec2[3](bitsOf(v.x), bitsOf(v.y), bitsOf(v.z)); }
double hiOf(SearchState state) { return quotient(double(uintBitsToFloat(state.hi)), double(sweeps[s].scale)); }
#else
#include "shared/double_bits.glsl"
uvec2 bitsOf(uvec2 x) { return x; }
// Times a power of two, by the exponent.
uvec2 unscaled(float x, float scale) {
  const uvec2 bits = doubleBits(floatBitsToUint(x));
  const int shift = int(floatBitsToUint(scale) >> 23) - 127;
  return x == 0.0 ? uvec2(0) : uvec2(bits.x, uint(int(bits.y) - (shift << 20)));
}
#endif

// Of the bits of doubles that are not negative.
bool isAbove(uvec2 p, uvec2 q) { return p.y > q.y || (p.y == q.y && p.x > q.x); }

RadarResult nothing(uint status) {
  const uvec2 n = uvec2(0, 0x7ff80000u);  // no number
  return RadarResult(status, RADAR_TIER_CONTACT, RADAR_NOT_LOOKED, 0, n, n, n, n, kNobody, kNobody, kNobody, 0,
                     uvec2[3](n, n, n), uvec2[3](n, n, n), n);
}

RadarResult invalid(uint flags) {
  RadarResult r = nothing(RADAR_INVALID);
  r.flags = flags;
  return r;
}

// Nothing is met; that is certain unless something was to be.
RadarResult noContact(bool met) { return nothing(met ? RADAR_INVALID : RADAR_CLEAR); }

// To a query that asks for no more, whichever way it is found out.
RadarResult within() {
  RadarResult r = nothing(RADAR_HIT);
  r.detected = RADAR_DETECTED;
  r.lo = uvec2(0);
  r.hi = bitsOf(sweeps[s].distance);
  return r;
}

RadarResult undecided(bool met, uvec2 low) {
  RadarResult r = nothing(RADAR_UNDECIDED);
  r.flags = RADAR_UNRESOLVED;
  if (met) r.detected = RADAR_DETECTED;
  const uvec2 distance = bitsOf(sweeps[s].distance);
  r.lo = isAbove(low, distance) ? distance : low;
  return r;
}

#ifndef RADAR_NO_DOUBLES
#include "placed_corners.glsl"
#include "double_double.glsl"
const double kNever = 1.0e200LF;
const double kRounded = 8.0LF * 1.1102230246251565e-16LF;

// The corners of a refined pair's triangles: the sensor's, the scene's.
struct Corners {
  dvec3 a[3], b[3];
};

Corners cornersOf(RefinedPair c) {
  Corners corners;
  placedCorners(sweeps[s].pose, c.slotA, corners.a);
  placedCorners(objects[c.object].pose, c.slotB, corners.b);
  return corners;
}

bool sameParts(uint featureP, Corners cornersP, uint featureQ, Corners cornersQ) {
  // A face by its three corners, an edge by two, a vertex by one.
  const uint kindP = featureP < 3 ? 0 : featureP < kFeatureEdges ? 1 : 2;
  const uint kindQ = featureQ < 3 ? 0 : featureQ < kFeatureEdges ? 1 : 2;
  const Event p = eventOf(featureP, cornersP.a, cornersP.b), q = eventOf(featureQ, cornersQ.a, cornersQ.b);
  return kindP == kindQ && p.from == q.from && p.to == q.to && p.x0 == q.x0 && p.x1 == q.x1 && p.y0 == q.y0 && p.y1 == q.y1;
}

// Tells of the refined pair's first contact, at s > 0; false where rounding is not certain.
bool tellHit(uint feature, Corners corners, inout RadarResult r) {
  const dvec3 direction = dvec3(sweeps[s].direction[0], sweeps[s].direction[1], sweeps[s].direction[2]);
  const Event e = eventOf(feature, corners.a, corners.b);
  const Told told = tellEvent(feature, e, direction);
  precise double t = told.s * sweeps[s].directionLength;
  precise double slack = kRounded * t;
  const double distance = sweeps[s].distance;
  const double first = min(t, distance);
  precise double below = t - slack, above = t + slack;
  r.status = RADAR_HIT;
  r.t = bitsOf(first);
  r.lo = bitsOf(min(max(below, 0.0LF), first));
  r.hi = bitsOf(min(above, distance));
  r.fraction = bitsOf(soundQuotient(first, distance));
  dvec3 normal;
  const bool unit = normalOf(e, told.turn, normal);
  r.point = bitsOf(told.point);
  r.normal = bitsOf(normal);
  return sound && told.known && unit && t > 1e-270LF && t * (1.0LF + kRounded) < distance;
}

void tellOverlap(Corners corners, inout RadarResult r) {
  dvec3 point;
  r.status = RADAR_OVERLAP;
  r.t = r.lo = r.hi = r.fraction = uvec2(0);
  if (commonPoint(corners.a, corners.b, point)) r.point = bitsOf(point);
}

// What of a sensor's refined pairs may be first.
struct Kept {
  uint count;            // of all refined pairs
  double limit;          // none is first that begins beyond
  double low;            // they do not meet before
  uint open;             // that may be first
  uvec4 least, pierced;  // of all, and of those that certainly meet at the start: the least name, and whose it is
};

Kept keep(uint first, double hi) {
  const double length = sweeps[s].directionLength;
  Kept kept = Kept(0, hi, kNever, 0, uvec4(kNobody), uvec4(kNobody));
  for (uint i = first; i != kNobody && kept.count < kMostListed; i = refinedPairs[i].next) {
    const RefinedPair c = refinedPairs[i];
    if ((c.flags & kPairMeets) != 0) kept.limit = min(kept.limit, max(c.at + c.error, 0.0LF) * length * (1.0LF + kRounded));
    ++kept.count;
  }
  for (uint i = first, k = 0; k < kept.count; i = refinedPairs[i].next, ++k) {
    const RefinedPair c = refinedPairs[i];
    if (c.low > kept.limit) continue;
    kept.low = min(kept.low, c.low);
    ++kept.open;
    const uvec3 name = nameOf(c);
    if (isLess(name, kept.least.xyz)) kept.least = uvec4(name, i);
    if ((c.flags & kPairPierces) != 0 && isLess(name, kept.pierced.xyz)) kept.pierced = uvec4(name, i);
  }
  return kept;
}

// Tells of what may be first where all of it certainly is, with the same features; where something certainly meets at the
// start: where nothing of a lesser name may, too. False where that is not certain.
bool tell(uint first, Kept kept, inout RadarResult r) {
  if (kept.count > kMostCompared || sweeps[s].anyHit != 0) return false;
  const bool pierces = kept.pierced.w != kNobody;
  const uvec4 winner = pierces ? kept.pierced : kept.least;
  const RefinedPair one = refinedPairs[winner.w];
  const Corners corners = cornersOf(one);
  bool certain = pierces || (one.flags & kPairSharp) != 0;
  for (uint i = first; i != kNobody && certain; i = refinedPairs[i].next) {
    const RefinedPair c = refinedPairs[i];
    if (c.low > kept.limit) continue;
    if (pierces) {
      certain = (c.flags & kPairPierces) != 0 || !isLess(nameOf(c), winner.xyz);
    } else {
      certain = (c.flags & kPairSharp) != 0 && c.at == one.at &&
                sameParts(one.flags & 0xffu, corners, c.flags & 0xffu, cornersOf(c));
    }
  }
  if (!certain) return false;
  r.detected = RADAR_DETECTED;
  r.object = winner.x;
  r.triB = winner.y;
  r.triA = winner.z;
  if (!pierces) return tellHit(one.flags & 0xffu, corners, r);
  tellOverlap(corners, r);
  return sound;
}

RadarResult answer(SearchState state) {
  const bool met = uintBitsToFloat(state.hi) < sweeps[s].start;
  if (sweeps[s].anyHit != 0 && met) return within();
  const Kept kept = keep(heads[s], hiOf(state));
  if (kept.least.w == kNobody) return noContact(met);
  if (kept.count == kMostListed) return invalid(RADAR_TOO_MANY_CANDIDATES);
  RadarResult r = nothing(RADAR_UNDECIDED);
  if (tell(heads[s], kept, r)) return r;
  uint at = roomFor(kept.open);
  for (uint i = heads[s]; i != kNobody && at != kNobody; i = refinedPairs[i].next) {
    if (refinedPairs[i].low <= kept.limit) list(at++, refinedPairs[i]);
  }
  return undecided(met, bitsOf(kept.low));
}
#else
RadarResult answer(SearchState state) {
  const bool met = uintBitsToFloat(state.hi) < sweeps[s].start;
  if (sweeps[s].anyHit != 0 && met) return within();
  if (heads[s] == kNobody) return noContact(met);
  // What is in the list was held against `hi`.
  float low = 3.0e38;
  uint count = 0;
  for (uint i = heads[s]; i != kNobody && count < kMostListed; i = refinedPairs[i].next, ++count) {
    low = min(low, refinedPairs[i].first);
  }
  if (count == kMostListed) return invalid(RADAR_TOO_MANY_CANDIDATES);
  uint at = roomFor(count);
  for (uint i = heads[s]; i != kNobody && at != kNobody; i = refinedPairs[i].next) list(at++, refinedPairs[i]);
  return undecided(met, unscaled(low, sweeps[s].scale));
}
#endif

void main() {
  s = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (s >= push.sensors) return;
  const SearchState state = states[s];
  const uint missing = ((state.flags & kSearchLost) != 0 ? RADAR_TOO_MANY_CANDIDATES : 0) |
                       ((state.flags & kSearchUnfinished) != 0 ? RADAR_TOO_LONG : 0) |
                       ((state.flags & kSearchOutOfRange) != 0 ? RADAR_OUT_OF_RANGE : 0);
  RadarResult r;
  if (missing != 0) {
    r = invalid(missing);
  } else {
    r = answer(state);
  }
  results[sweeps[s].result] = r;
}
