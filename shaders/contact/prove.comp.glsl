// Proves quickly of open pairs that they block, which spares block.comp the others that begin later; the proofs are those of
// engine/cpu/certificate.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "refined_pair.glsl"
#include "shared/triangle_pair_bounds.glsl"
#include "slack.glsl"

double largest(dvec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// -1 or 1: the side of the plane through the origin with the normal x cross y on which w is, if w is certainly farther from it
// than the slack; else 0.
int sideBeyond(dvec3 w, dvec3 x, dvec3 y, double slack) {
  const Bounded at = planeOf(w, x, y, w);
  // No component of x cross y exceeds twice the product of the largest of each.
  const double margin = at.error + 2.125LF * slack * (largest(x) * largest(y));
  return at.value > margin ? 1 : at.value < -margin ? -1 : 0;
}

// Whether some corner is certainly farther than the slack from the plane of a face.
bool leavesPlane(dvec3 face[3], dvec3 corners[3], double slack) {
  const dvec3 x = face[1] - face[0], y = face[2] - face[0];
  return sideBeyond(corners[0] - face[0], x, y, slack) != 0 || sideBeyond(corners[1] - face[0], x, y, slack) != 0 ||
         sideBeyond(corners[2] - face[0], x, y, slack) != 0;
}

// Whether contact at a certain feature ahead certainly blocks, because everything within the slack of it is inside both parts,
// as seen along the direction d. Corners are sorted.
bool certainlyBlocks(uint feature, dvec3 a[3], dvec3 b[3], dvec3 d, double slack) {
  // Triangles in the plane of either, up to the slack, are judged by another rule.
  if (!leavesPlane(a, b, slack) || !leavesPlane(b, a, slack)) return false;
  if (feature < kFeatureEdges) {
    const bool ofA = feature >= 3;
    const dvec3 corner = ofA ? b[feature - 3] : a[feature];
    const dvec3 f0 = ofA ? a[0] : b[0], f1 = ofA ? a[1] : b[1], f2 = ofA ? a[2] : b[2];
    const int sides = sideBeyond(f0 - corner, d, f1 - f0, slack) + sideBeyond(f1 - corner, d, f2 - f1, slack) +
                      sideBeyond(f2 - corner, d, f0 - f2, slack);
    return abs(sides) == 3 && sideBeyond(f0 - corner, f1 - f0, f2 - f0, slack) != 0;
  }
  const uint i = (feature - kFeatureEdges) / 3, k = (feature - kFeatureEdges) % 3;
  const dvec3 a0 = i == 1 ? a[1] : a[0], a1 = i == 0 ? a[1] : a[2], b0 = k == 1 ? b[1] : b[0], b1 = k == 0 ? b[1] : b[2];
  const dvec3 x = a1 - a0, y = b1 - b0, w = b0 - a0;
  return sideBeyond(w, d, x, slack) * sideBeyond(b1 - a0, d, x, slack) < 0 &&
         sideBeyond(w, d, y, slack) * sideBeyond(b0 - a1, d, y, slack) < 0 && sideBeyond(w, x, y, slack) != 0;
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.openPairs) return;
  const uint i = refinedPairs[place].open;
  const RefinedPair c = refinedPairs[i];
  if (sweeps[c.search].ignoreLeaving == 0) return;
  const double last = c.at + c.error;
  if ((c.flags & kPairMeets) == 0 || c.at <= c.error || !wouldLowerHi(c.search, sweeps[c.search], last)) return;
  dvec3 a[3], b[3];
  placedCorners(sweeps[c.search].pose, c.slotA, a);
  placedCorners(objects[c.object].pose, c.slotB, b);
  const Bounded slack = slackOf(sweeps[c.search], c);
  const double direction[3] = sweeps[c.search].direction;
  if (!certainlyBlocks(c.flags & 0xffu, a, b, dvec3(direction[0], direction[1], direction[2]), slack.value + slack.error)) return;
  refinedPairs[i].flags = c.flags | kPairBlocks;
  lowerHi(c.search, sweeps[c.search], last);
}
