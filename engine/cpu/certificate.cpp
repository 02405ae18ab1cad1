#include "cpu/certificate.h"

#include <algorithm>
#include <cmath>

#include "exact/determinant.h"
#include "exact/event.h"

namespace radar::cpu {

namespace {

/// -1 or 1: the sign of w . (x cross y); 0 if doubles cannot decide it. All three vectors are differences of doubles,
/// rounded once.
inline int sureSign(const Vector& w, const Vector& x, const Vector& y) {
  const exact::Estimate rough = exact::estimate(w, x, y, exact::underflowOf(w));
  return std::abs(rough.value) > rough.error ? exact::signOf(rough.value) : 0;
}

/// Whether a line along d through p certainly passes through the inside of a triangle.
bool isOver(const Vector& p, const exact::Triangle& face, const Vector& d) {
  const Vector to[3] = {minus(face[0], p), minus(face[1], p), minus(face[2], p)};
  const int side = sureSign(d, to[0], to[1]);
  return side != 0 && sureSign(d, to[1], to[2]) == side && sureSign(d, to[2], to[0]) == side;
}

/// The one corner that is certainly farthest in the direction side * (x cross y), or -1.
int farthest(const exact::Triangle& triangle, const Vector& x, const Vector& y, int side) {
  const int first = side * sureSign(minus(triangle[1], triangle[0]), x, y);
  const int second = side * sureSign(minus(triangle[2], triangle[0]), x, y);
  if (first < 0 && second < 0) return 0;
  const int last = side * sureSign(minus(triangle[2], triangle[1]), x, y);
  if (first > 0 && last < 0) return 1;
  return second > 0 && last > 0 ? 2 : -1;
}

}  // namespace

FeatureNumber Certificate::first(const exact::Triangle& a, const exact::Triangle& b, const Vector& d, Axis axis) {
  return axis < 2 ? acrossFace(a, b, d, axis == 0) : acrossEdges(a, b, d, (axis - 2) / 3, (axis - 2) % 3);
}

FeatureNumber Certificate::acrossFace(const exact::Triangle& a, const exact::Triangle& b, const Vector& d, bool ofA) {
  const exact::Triangle face = exact::sorted(ofA ? a : b), &other = ofA ? b : a;
  const exact::Kind kind = ofA ? exact::Kind::faceVertex : exact::Kind::vertexFace;
  const Vector x = minus(face[1], face[0]), y = minus(face[2], face[0]);
  const bool isKnown = side_ != 0 && event_.kind == kind && event_.x0 == face[0] && event_.x1 == face[1] &&
                       event_.y1 == face[2] && event_.direction == d;
  const int side = isKnown ? side_ : sureSign(d, x, y);
  if (side == 0) return kNoFeature;
  // The face of b is touched by the corner of a farthest along the motion, the face of a by that of b farthest against
  // it.
  const int corner = farthest(other, x, y, ofA ? -side : side);
  if (corner < 0) return kNoFeature;
  if (!isKnown || other[corner] != (ofA ? event_.to : event_.from)) {
    if (!isOver(other[corner], face, d)) return kNoFeature;
    event_ = ofA ? exact::faceVertex(d, face, other[corner]) : exact::vertexFace(d, other[corner], face);
    side_ = side;
  }
  return ofA ? 3 + corner : corner;
}

FeatureNumber Certificate::acrossEdges(const exact::Triangle& a, const exact::Triangle& b, const Vector& d, int i,
                                       int k) {
  const auto [p0, p1] = std::minmax(a[i], a[(i + 1) % 3]);
  const auto [q0, q1] = std::minmax(b[k], b[(k + 1) % 3]);
  const Vector x = minus(p1, p0), y = minus(q1, q0);
  const bool isKnown = side_ != 0 && event_.kind == exact::Kind::edgeEdge && event_.x0 == p0 && event_.x1 == p1 &&
                       event_.y0 == q0 && event_.y1 == q1 && event_.direction == d;
  const int side = isKnown ? side_ : sureSign(d, x, y);
  if (side == 0 || sureSign(minus(a[(i + 2) % 3], p0), x, y) != -side ||
      sureSign(minus(b[(k + 2) % 3], q0), x, y) != side) {
    return kNoFeature;
  }
  if (!isKnown) {
    // Seen along d, the ends of each edge must be on different sides of the other.
    const Vector w00 = minus(q0, p0), w01 = minus(q1, p0), w10 = minus(q0, p1), w11 = minus(q1, p1);
    const int p = sureSign(d, w00, w10), r = sureSign(d, w00, w01);
    if (p == 0 || r == 0 || sureSign(d, w01, w11) != -p || sureSign(d, w10, w11) != -r) return kNoFeature;
    event_ = exact::edgeEdge(d, p0, p1, q0, q1);
    side_ = side;
  }
  return 6 + 3 * i + k;
}

namespace {

/// -1 or 1: the side of the plane through the origin with the normal x cross y on which w is, if w is certainly
/// farther from it than `slack` in the sense of exact/blocking.h; else 0.
int sideBeyond(const Vector& w, const Vector& x, const Vector& y, double slack) {
  const exact::Estimate rough = exact::estimate(w, x, y, exact::underflowOf(w));
  // No component of x cross y exceeds twice the product of the largest of each.
  const double margin = 2.125 * slack * (largest(x) * largest(y));
  return std::abs(rough.value) > rough.error + margin ? exact::signOf(rough.value) : 0;
}

/// Whether some corner is certainly farther than `slack` from the plane of a face.
bool leavesPlane(const exact::Triangle& face, const exact::Triangle& corners, double slack) {
  const Vector x = minus(face[1], face[0]), y = minus(face[2], face[0]);
  return sideBeyond(minus(corners[0], face[0]), x, y, slack) != 0 ||
         sideBeyond(minus(corners[1], face[0]), x, y, slack) != 0 ||
         sideBeyond(minus(corners[2], face[0]), x, y, slack) != 0;
}

}  // namespace

bool mayShareAPlane(const exact::Triangle& a, const exact::Triangle& b, double slack) {
  return !leavesPlane(a, b, slack) || !leavesPlane(b, a, slack);
}

bool certainlyBlocks(FeatureNumber feature, const exact::Triangle& a, const exact::Triangle& b, const Vector& d,
                     double slack) {
  if (feature < 6) {
    const bool ofA = feature >= 3;
    const exact::Triangle& face = ofA ? a : b;
    const Vector& corner = ofA ? b[feature - 3] : a[feature];
    int sides = 0;
    for (int i = 0; i < 3; ++i) {
      sides += sideBeyond(minus(face[i], corner), d, minus(face[(i + 1) % 3], face[i]), slack);
    }
    return std::abs(sides) == 3 &&
           sideBeyond(minus(face[0], corner), minus(face[1], face[0]), minus(face[2], face[0]), slack) != 0;
  }
  const int i = (feature - 6) / 3, k = (feature - 6) % 3;
  const Vector &a0 = a[i], &a1 = a[(i + 1) % 3], &b0 = b[k], &b1 = b[(k + 1) % 3];
  const Vector x = minus(a1, a0), y = minus(b1, b0), w = minus(b0, a0);
  return sideBeyond(w, d, x, slack) * sideBeyond(minus(b1, a0), d, x, slack) < 0 &&
         sideBeyond(w, d, y, slack) * sideBeyond(minus(b0, a1), d, y, slack) < 0 && sideBeyond(w, x, y, slack) != 0;
}

}  // namespace radar::cpu
