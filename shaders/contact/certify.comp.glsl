// Solves those refined pairs in double precision whose contact certainly begins at the feature that the search names, whatever
// the time, as engine/cpu/certificate.cpp does: a fraction of the work. The others are left to refine.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "refined_pair.glsl"
#include "shared/triangle_pair_bounds.glsl"

int sideOf(dvec3 w, dvec3 x, dvec3 y) { return signOf(planeOf(w, x, y, w)); }

// The place of a corner once they are sorted.
uint placeOf(uint corner, dvec3 p[3]) {
  const dvec3 own = picked(p, corner);
  uint place = 0;
  for (uint i = 0; i < 3; ++i) {
    const bool isBefore = before(p[i], own), isEqual = !isBefore && !before(own, p[i]);
    if (isBefore || (isEqual && i < corner)) ++place;
  }
  return place;
}

// Edges (0,1), (1,2), (0,2) by the corner opposite, 2, 0, 1.
uint placeOfEdge(uint edge, dvec3 p[3]) { return (placeOf((edge + 2) % 3, p) + 1) % 3; }

// The number of a feature of triangles whose corners are not sorted, once they are.
uint sortedFeature(uint feature, dvec3 a[3], dvec3 b[3]) {
  if (feature < 3) return placeOf(feature, a);
  if (feature < kFeatureEdges) return 3 + placeOf(feature - 3, b);
  return kFeatureEdges + 3 * placeOfEdge((feature - kFeatureEdges) / 3, a) + placeOfEdge((feature - kFeatureEdges) % 3, b);
}

// Whether contact certainly begins at this feature; then `at` is where, in multiples of the direction. It does if its parts are
// certainly the farthest of each triangle towards the other, and a line along the motion certainly passes through the inside of
// their difference: of a face less a corner, or of the parallelogram of two edges.
bool certifies(uint feature, dvec3 a[3], dvec3 b[3], dvec3 direction, out Bounded at) {
  const bool isEdges = feature >= kFeatureEdges, ofA = !isEdges && feature >= 3;
  // The face q0 q1 q2 and the corner p0, or the edges q0 q1 and p0 p1; ways from a part to what is to be farther back.
  dvec3 q0, q1, q2, p0, p1, back0, back1;
  if (isEdges) {
    const uint i = (feature - kFeatureEdges) / 3, k = (feature - kFeatureEdges) % 3;
    p0 = i == 1 ? a[1] : a[0];
    p1 = i == 0 ? a[1] : a[2];
    q0 = k == 1 ? b[1] : b[0];
    q1 = k == 0 ? b[1] : b[2];
    q2 = k == 0 ? b[2] : k == 1 ? b[0] : b[1];
    back0 = (i == 0 ? a[2] : i == 1 ? a[0] : a[1]) - p0;
    back1 = q0 - q2;
  } else {
    const uint corner = ofA ? feature - 3 : feature;
    const dvec3 own[3] = dvec3[3](ofA ? b[0] : a[0], ofA ? b[1] : a[1], ofA ? b[2] : a[2]);
    q0 = ofA ? a[0] : b[0];
    q1 = ofA ? a[1] : b[1];
    q2 = ofA ? a[2] : b[2];
    p0 = p1 = picked(own, corner);
    back0 = picked(own, corner == 0 ? 1 : 0) - p0;
    back1 = picked(own, corner == 2 ? 1 : 2) - p0;
  }
  // They span the plane of contact. All numbers are those of impactOf, with its bits.
  const dvec3 x = isEdges ? p1 - p0 : q1 - q0, y = isEdges ? q1 - q0 : q2 - q0;
  const Bounded below = faceOf(x, y, direction);
  const int side = ofA ? signOf(below) : -signOf(below);
  if (side == 0 || sideOf(back0, x, y) != side || sideOf(back1, x, y) != side) return false;
  const dvec3 v0 = q0 - p0, v1 = (isEdges ? q0 : q1) - p1, v2 = (isEdges ? q1 : q2) - p1, v3 = (isEdges ? q1 : q0) - p0;
  const int over = sideOf(direction, v0, v1);
  if (over == 0 || sideOf(direction, v1, v2) != over || sideOf(direction, v2, v3) != over) return false;
  if (isEdges && sideOf(direction, v3, v0) != over) return false;
  bool known;
  at = quotientOf(planeOf(ofA ? -v0 : v0, x, y, direction), below, known);
  return known && at.value > at.error;
}

void leaveToRefine(uint pair) {
  const uint place = atomicAdd(counts.leftPairs, 1), group = place / kContactGroup;
  refinedPairs[place].left = pair;
  if (place % kContactGroup != 0) return;
  atomicMax(counts.refineGroups[0], min(group + 1, kMostWorkgroups));
  atomicMax(counts.refineGroups[1], group / kMostWorkgroups + 1);
}

void main() {
  const uint i = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (i >= counts.refinedPairs) return;
  const RefinedPair c = refinedPairs[i];
  const Sweep sweep = sweeps[c.search];
  if (sweep.cpuDecides != 0) return;
  bool certain = false;
  if (c.feature < kFeatures && sweep.ignoreLeaving == 0) {
    dvec3 a[3], b[3];
    cornersInOrder(sweep.pose, c.slotA, a);
    cornersInOrder(objects[c.object].pose, c.slotB, b);
    const uint feature = sortedFeature(c.feature, a, b);
    sortCorners(a);
    sortCorners(b);
    Bounded at;
    certain = certifies(feature, a, b, dvec3(sweep.direction[0], sweep.direction[1], sweep.direction[2]), at);
    if (certain) {
      const double low = (at.value - at.error) * sweep.directionLength * (1.0LF - kRounded);
      refinedPairs[i].low = low;
      refinedPairs[i].at = at.value;
      refinedPairs[i].error = at.error;
      refinedPairs[i].flags = kPairMeets | kPairSharp | feature;
      refinedPairs[i].first = max(c.first, scaledDown(low, sweep));
      lowerHi(c.search, sweep, at.value + at.error);
    }
  }
  if (!certain) leaveToRefine(i);
}
