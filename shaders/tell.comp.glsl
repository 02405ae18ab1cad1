// What a search has met becomes an answer, a subgroup for each sensor. Where the device is certain which features touch
// first, it tells the numbers, in the arithmetic of engine/exact and with its bits; else it lists the pairs that may be
// first, with what the host needs to decide them. On a device without doubles that is all that may be first.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "radar/result.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;

layout(scalar, binding = kBindOriginals) readonly restrict buffer Originals { vec3 originals[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uvec3 triangles[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kBindTargets) readonly restrict buffer Targets { Target targets[]; };
layout(scalar, binding = kBindStates) readonly restrict buffer States { State states[]; };
layout(scalar, binding = kBindContenders) readonly restrict buffer Contenders { Contender contenders[]; };
layout(scalar, binding = kBindSlotIds) readonly restrict buffer SlotIds { uint slotIds[]; };
layout(scalar, binding = kBindResults) writeonly restrict buffer Results { RadarResult results[]; };
layout(scalar, binding = kBindOpenContenders) restrict buffer OpenContenders { OpenCount opened; OpenContender open[]; };
#include "contender.glsl"

layout(push_constant) uniform Push { uint count; uint groupsX; uint openCapacity; } push;

// Lavapipe ends loops silently after 65,535 iterations in one invocation, nested ones included: where a lane has more
// contenders than this, of 36 each, they are not compared but listed. The host gives room for kMostListed of a lane at most.
const uint kMostCompared = 1024;

shared uint keptCount;
shared uint isUncertain;

uint v, lane;

uint triangleAt(uint mesh, uint slot) { return slotIds[meshes[mesh].firstIndex / 3 + slot]; }

// Ties go by this.
uvec3 nameOf(Contender c) {
  return uvec3(c.object, triangleAt(objects[c.object].mesh, c.slotB), triangleAt(targets[v].mesh, c.slotA));
}
bool isLess(uvec3 p, uvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

void list(Contender c) {
  const uint at = atomicAdd(opened.count, 1);
  if (at >= push.openCapacity) return;
  const uvec3 name = nameOf(c);
  const MeshRecord meshA = meshes[targets[v].mesh], meshB = meshes[objects[c.object].mesh];
  const uvec3 cornerA = triangles[meshA.firstIndex / 3 + c.slotA] + meshA.firstVertex;
  const uvec3 cornerB = triangles[meshB.firstIndex / 3 + c.slotB] + meshB.firstVertex;
  open[at] = OpenContender(v, name.x, name.y, name.z,
                           vec3[3](originals[cornerA.x], originals[cornerA.y], originals[cornerA.z]),
                           vec3[3](originals[cornerB.x], originals[cornerB.y], originals[cornerB.z]),
                           objects[c.object].pose);
}

#ifndef RADAR_NO_DOUBLES
#include "twofold.glsl"
const double kNever = 1.0e300LF;
const double kRounded = 8.0LF * 1.1102230246251565e-16LF;
shared double laneLow[128];
shared uvec4 laneLeast[128], lanePierced[128];  // a name, and whose it is

const uvec2 kNan = uvec2(0, 0x7ff80000u);
double nan() { return packDouble2x32(kNan); }

RadarResult nothing(uint status) {
  const double n = nan();
  return RadarResult(status, RADAR_TIER_CONTACT, RADAR_NOT_LOOKED, 0, n, n, n, n, kNobody, kNobody, kNobody, 0, double[3](n, n, n),
                     double[3](n, n, n), n);
}

// Of a query that asks for no more.
RadarResult within(double hi) {
  RadarResult r = nothing(RADAR_HIT);
  r.detected = RADAR_DETECTED;
  r.lo = 0.0LF;
  r.hi = hi;
  return r;
}

// No contact is first that begins beyond.
double limitOf(uint first, uint count, double hi) {
  const double length = targets[v].directionLength;
  double limit = hi;
  for (uint i = lane; i < count; i += kLanes) {
    const Contender c = contenders[first + i];
    if ((c.flags & kContenderMeets) != 0) limit = min(limit, max(c.at + c.error, 0.0LF) * length * (1.0LF + kRounded));
  }
  laneLow[lane] = limit;
  barrier();
  for (uint i = 0; i < kLanes; ++i) limit = min(limit, laneLow[i]);
  barrier();
  return limit;
}

// The corners of a contender's triangles: the sensor's, the scene's.
struct Corners {
  dvec3 of[2][3];
};

Corners cornersOf(Contender c) {
  Corners corners;
  for (uint side = 0; side < three() - 1; ++side) {
    PreciseRows pose;
    for (int k = 0; k < 3; ++k) pose[k] = side == 0 ? targets[v].pose[k] : objects[c.object].pose[k];
    const uint mesh = side == 0 ? targets[v].mesh : objects[c.object].mesh;
    placedCorners(pose, mesh, side == 0 ? c.slotA : c.slotB, corners.of[side]);
  }
  return corners;
}

bool sameParts(uint featureP, Corners cornersP, uint featureQ, Corners cornersQ) {
  // A face by its three corners, an edge by two, a vertex by one.
  const uint kindP = featureP < 3 ? 0 : featureP < kFeatureEdges ? 1 : 2;
  const uint kindQ = featureQ < 3 ? 0 : featureQ < kFeatureEdges ? 1 : 2;
  const Event p = eventOf(featureP, cornersP.of[0], cornersP.of[1]), q = eventOf(featureQ, cornersQ.of[0], cornersQ.of[1]);
  return kindP == kindQ && p.from == q.from && p.to == q.to && p.x0 == q.x0 && p.x1 == q.x1 && p.y0 == q.y0 && p.y1 == q.y1;
}

// Tells of the contender's first contact, at s > 0; false where rounding is not certain.
bool tellHit(uint feature, Corners corners, inout RadarResult r) {
  const dvec3 direction = dvec3(targets[v].direction[0], targets[v].direction[1], targets[v].direction[2]);
  const Event e = eventOf(feature, corners.of[0], corners.of[1]);
  const Told told = tellEvent(feature, e, direction);
  precise double t = told.s * targets[v].directionLength;
  precise double slack = kRounded * t;
  const double distance = targets[v].distance;
  r.status = RADAR_HIT;
  r.t = min(t, distance);
  precise double below = t - slack, above = t + slack;
  r.lo = min(max(below, 0.0LF), r.t);
  r.hi = min(above, distance);
  precise double fraction = r.t / distance;
  r.fraction = fraction;
  dvec3 normal;
  const bool unit = normalOf(e, told.turn, normal);
  r.point = double[3](told.point.x, told.point.y, told.point.z);
  r.normal = double[3](normal.x, normal.y, normal.z);
  return told.known && unit && t > 1e-270LF && t * (1.0LF + kRounded) < distance;
}

void tellOverlap(Corners corners, inout RadarResult r) {
  dvec3 point;
  r.status = RADAR_OVERLAP;
  r.t = r.lo = r.hi = r.fraction = 0.0LF;
  if (commonPoint(corners.of[0], corners.of[1], point)) r.point = double[3](point.x, point.y, point.z);
}

// What of a sensor's contenders may be first.
struct Kept {
  double low;            // they do not meet before
  uvec4 least, pierced;  // of all, and of those that certainly meet at the start: the least name, and whose it is
};

Kept keep(uint first, uint count, double limit) {
  Kept kept = Kept(kNever, uvec4(kNobody), uvec4(kNobody));
  for (uint i = lane; i < count; i += kLanes) {
    const Contender c = contenders[first + i];
    if (c.low > limit) continue;
    atomicAdd(keptCount, 1);
    kept.low = min(kept.low, c.low);
    const uvec3 name = nameOf(c);
    if (isLess(name, kept.least.xyz)) kept.least = uvec4(name, i);
    if ((c.flags & kContenderPierces) != 0 && isLess(name, kept.pierced.xyz)) kept.pierced = uvec4(name, i);
  }
  laneLow[lane] = kept.low;
  laneLeast[lane] = kept.least;
  lanePierced[lane] = kept.pierced;
  barrier();
  for (uint i = 0; i < kLanes; ++i) {
    kept.low = min(kept.low, laneLow[i]);
    if (isLess(laneLeast[i].xyz, kept.least.xyz)) kept.least = laneLeast[i];
    if (isLess(lanePierced[i].xyz, kept.pierced.xyz)) kept.pierced = lanePierced[i];
  }
  return kept;
}

// Tells of what may be first where all of it certainly is, with the same features; where something certainly meets at the
// start: where nothing of a lesser name may, too. False where that is not certain.
bool tell(uint first, uint count, double limit, Kept kept, inout RadarResult r) {
  if (count > kMostCompared * kLanes || targets[v].decides != 0) return false;
  const bool pierces = kept.pierced.w != kNobody;
  const uvec4 winner = pierces ? kept.pierced : kept.least;
  Contender one;
  Corners corners;
  // The winner goes first, in every lane.
  for (uint i = lane, step = 0; i < count; i += step++ == 0 ? 0 : kLanes) {
    const Contender c = contenders[first + (step == 0 ? winner.w : i)];
    if (step != 0 && c.low > limit) continue;
    if (step != 0 && pierces) {
      if ((c.flags & kContenderPierces) == 0 && isLess(nameOf(c), winner.xyz)) isUncertain = 1;
      continue;
    }
    const Corners theirs = cornersOf(c);
    if (step == 0) {
      one = c;
      corners = theirs;
    }
    if (!pierces && ((c.flags & kContenderSharp) == 0 || c.at != one.at ||
                     !sameParts(one.flags & 0xffu, corners, c.flags & 0xffu, theirs))) {
      isUncertain = 1;
    }
  }
  barrier();
  if (isUncertain != 0) return false;
  r.detected = RADAR_DETECTED;
  r.object = winner.x;
  r.triB = winner.y;
  r.triA = winner.z;
  if (!pierces) return tellHit(one.flags & 0xffu, corners, r);
  tellOverlap(corners, r);
  return true;
}

RadarResult answer() {
  const State state = states[v];
  const uint first = targets[v].firstContender, count = state.contenderCount;
  const bool met = double(state.hi) < targets[v].distance;
  if (targets[v].decides != 0 && met) return within(double(state.hi));
  double limit = double(state.hi);
  Kept kept = Kept(0.0LF, uvec4(kNobody), uvec4(kNobody));
  if (count <= kMostCompared * kLanes) {
    limit = limitOf(first, count, limit);
    kept = keep(first, count, limit);
    if (keptCount == 0) return nothing(met ? RADAR_INVALID : RADAR_CLEAR);
  }
  RadarResult r = nothing(RADAR_UNDECIDED);
  if (tell(first, count, limit, kept, r)) return r;
  for (uint i = lane; i < count; i += kLanes) {
    const Contender c = contenders[first + i];
    if (c.low <= limit) list(c);
  }
  r = nothing(RADAR_UNDECIDED);
  r.flags = RADAR_OPEN;
  if (met) r.detected = RADAR_DETECTED;
  r.lo = min(kept.low, targets[v].distance);
  return r;
}
#else
RadarResult nothing(uint status) {
  const uvec2 n = uvec2(0, 0x7ff80000u);
  return RadarResult(status, RADAR_TIER_CONTACT, RADAR_NOT_LOOKED, 0, n, n, n, n, kNobody, kNobody, kNobody, 0, uvec2[3](n, n, n),
                     uvec2[3](n, n, n), n);
}

// Of doubles that are not negative.
bool isAbove(uvec2 p, uvec2 q) { return p.y > q.y || (p.y == q.y && p.x > q.x); }
shared uint leastHigh;

RadarResult answer() {
  const State state = states[v];
  const uint first = targets[v].firstContender, count = state.contenderCount;
  const uvec2 limit = doubleBits(state.hi);
  const bool met = !isinf(state.hi) && isAbove(targets[v].distance, limit);
  RadarResult r = nothing(met ? RADAR_INVALID : RADAR_CLEAR);
  if (targets[v].decides != 0 && met) {
    r.status = RADAR_HIT;
    r.detected = RADAR_DETECTED;
    r.lo = uvec2(0);
    r.hi = limit;
    return r;
  }
  // What bits there are below the upper word, a lower bound can do without.
  for (uint i = lane; i < count; i += kLanes) {
    const Contender c = contenders[first + i];
    if (isAbove(c.low, limit)) continue;
    atomicAdd(keptCount, 1);
    atomicMin(leastHigh, c.low.y);
    list(c);
  }
  barrier();
  if (keptCount == 0) return r;
  const uvec2 low = uvec2(0, leastHigh);
  r = nothing(RADAR_UNDECIDED);
  r.flags = RADAR_OPEN;
  if (met) r.detected = RADAR_DETECTED;
  r.lo = isAbove(low, targets[v].distance) ? targets[v].distance : low;
  return r;
}
#endif

void main() {
  v = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (v >= push.count) return;
  lane = gl_LocalInvocationID.x;
  if (lane == 0) {
    keptCount = isUncertain = 0;
#ifdef RADAR_NO_DOUBLES
    leastHigh = kNobody;
#endif
  }
  barrier();
  const State state = states[v];
  uint missing = 0;
  if (state.pairCount > targets[v].pairCapacity) {
    missing = RADAR_TOO_MANY_CLUSTER_PAIRS;
  } else if (state.progress == kSearchOverflow) {
    missing = RADAR_TOO_MANY_CONTENDERS;
  } else if (state.progress != kSearchDone) {
    missing = RADAR_TOO_LONG;
  }
  RadarResult r;
  if (missing != 0) {
    r = nothing(RADAR_INVALID);
    r.flags = missing;
  } else {
    r = answer();
  }
  if (lane == 0) results[targets[v].result] = r;
}
