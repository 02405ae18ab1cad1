#include "exact/nearness.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exact/three.h"

namespace radar::exact {

namespace {

using Point = Three<Dyadic>;

Point difference(const Point& p, const Point& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

Dyadic square(const Dyadic& x) {
  return x * x;
}

/// num / den, den > 0.
struct Fraction {
  Dyadic num, den;
};

bool isLess(const Fraction& p, const Fraction& q) {
  return (p.num * q.den - q.num * p.den).sign() < 0;
}

/// An edge of a triangle, or the way of a corner, which has no end.
struct Line {
  Point from, way;
  bool ends;

  /// Whether num / den, den > 0, is a share of `way` inside the line.
  bool contains(const Dyadic& num, const Dyadic& den) const {
    return num.sign() > 0 && (!ends || (num - den).sign() < 0);
  }
};

/// A triangle from + s x + t y, s, t >= 0, s + t <= 1; or the way of an edge y along x, t <= 1.
struct Face {
  Point from, x, y;
  bool isWay;
};

/// The least square of a distance, among those of all pairs of features.
class Least {
 public:
  void offerPoints(const Point& p, const Point& q) {
    const Point gap = difference(p, q);
    offer({inner(gap, gap), Dyadic(1)});
  }

  /// From a point to the inside of a line.
  void offerLine(const Point& p, const Line& line) {
    const Point gap = difference(p, line.from), across = crossProduct(gap, line.way);
    const Dyadic length = inner(line.way, line.way);
    if (length.sign() > 0 && line.contains(inner(gap, line.way), length)) offer({inner(across, across), length});
  }

  /// Between the insides of two lines.
  void offerLines(const Line& p, const Line& q) {
    const Point normal = crossProduct(p.way, q.way), gap = difference(q.from, p.from);
    const Dyadic size = inner(normal, normal);
    if (size.sign() == 0) return;
    if (!p.contains(inner(crossProduct(gap, q.way), normal), size)) return;
    if (!q.contains(inner(crossProduct(gap, p.way), normal), size)) return;
    offer({square(inner(gap, normal)), size});
  }

  /// From a point to the inside of a face.
  void offerFace(const Point& p, const Face& face) {
    const Point normal = crossProduct(face.x, face.y), gap = difference(p, face.from);
    const Dyadic size = inner(normal, normal);
    if (size.sign() == 0) return;
    const Dyadic s = inner(crossProduct(gap, face.y), normal), t = inner(crossProduct(face.x, gap), normal);
    if (s.sign() < 0 || t.sign() < 0 || ((face.isWay ? t : s + t) - size).sign() > 0) return;
    offer({square(inner(gap, normal)), size});
  }

  const Fraction& square() const { return *least_; }

 private:
  static Dyadic square(const Dyadic& x) { return x * x; }
  void offer(const Fraction& candidate) {
    if (!least_ || isLess(candidate, *least_)) least_ = candidate;
  }
  std::optional<Fraction> least_;
};

/// Two triangles that do not meet on their way.
class Nearness {
 public:
  Nearness(const Triangle& a, const Triangle& b, const Vector& direction, int exponent)
      : moves_(direction != Vector{}) {
    for (size_t i = 0; i < 3; ++i) {
      a_[i] = placed(a[i], a[0], exponent);
      b_[i] = placed(b[i], a[0], exponent);
    }
    way_ = numbers<Dyadic>(direction);
  }

  /// At the start.
  Fraction atStart() const {
    Least least;
    offerStart(least);
    return least.square();
  }

  /// The least from the start on.
  Fraction everAfter() const {
    Least least;
    offerStart(least);
    for (size_t i = 0; i < 3 && moves_; ++i) {
      const Line way{a_[i], way_, false};
      const Face strip{a_[i], way_, difference(a_[(i + 1) % 3], a_[i]), true};
      for (size_t k = 0; k < 3; ++k) {
        least.offerLine(b_[k], way);
        least.offerLines(way, edge(b_, k));
        least.offerFace(b_[k], strip);
      }
    }
    return least.square();
  }

 private:
  using Corners = std::array<Point, 3>;

  static Point placed(const Vector& p, const Vector& origin, int exponent) {
    Point out;
    for (size_t k = 0; k < 3; ++k) {
      // Two numbers, each of which keeps its digits unless it vanishes beside the greatest.
      const double floor = std::ldexp(1.0, -400);
      const auto part = [&](double v) {
        const double scaled = std::ldexp(v, -exponent);
        return Dyadic(std::abs(scaled) < floor ? 0 : scaled);
      };
      out[k] = part(p[k]) - part(origin[k]);
    }
    return out;
  }

  static Line edge(const Corners& corners, size_t i) {
    return {corners[i], difference(corners[(i + 1) % 3], corners[i]), true};
  }
  static Face face(const Corners& corners) {
    return {corners[0], difference(corners[1], corners[0]), difference(corners[2], corners[0]), false};
  }

  void offerStart(Least& least) const {
    for (size_t i = 0; i < 3; ++i) {
      least.offerFace(a_[i], face(b_));
      least.offerFace(b_[i], face(a_));
      for (size_t k = 0; k < 3; ++k) {
        least.offerPoints(a_[i], b_[k]);
        least.offerLine(a_[i], edge(b_, k));
        least.offerLine(b_[i], edge(a_, k));
        least.offerLines(edge(a_, i), edge(b_, k));
      }
    }
  }

  bool moves_;
  Corners a_, b_;
  Point way_;
};

}  // namespace

bool blocksWithin(const Triangle& a, const Triangle& b, const Way& way, double clearance, double slack,
                  Mirrored mirrored) {
  if (clearance <= slack) return blocks(a, b, way, slack, mirrored);
  const bool stands = way.direction == Vector{};
  const auto interval = contact(a, b, stands ? Vector{1, 0, 0} : way.direction);
  const bool meets = interval && sign(interval->last) >= 0;
  // What touches at the start has no distance to lose.
  if (meets && sign(interval->first) <= 0) return blocks(a, b, way, slack, mirrored);
  double size = clearance;
  for (const Triangle* t : {&a, &b}) {
    for (const Vector& p : *t) size = std::max(size, largest(p));
  }
  const int exponent = std::ilogb(size);
  Vector direction = way.direction;
  const int turn = stands ? 0 : std::ilogb(largest(direction));
  for (double& c : direction) c = std::ldexp(c, -turn);
  const Nearness pair(a, b, direction, exponent);
  const Dyadic c(std::ldexp(clearance, -exponent)), w(std::ldexp(slack, -exponent));
  const Fraction start = pair.atStart();
  if ((start.num - w * w * start.den).sign() <= 0) return blocks(a, b, way, slack, mirrored);
  if (meets && !stands) return true;
  const Fraction least = pair.everAfter();
  // sqrt(least) < c - w.
  if ((start.num - c * c * start.den).sign() >= 0) return (least.num - square(c - w) * least.den).sign() < 0;
  // sqrt(least) < sqrt(start) - w, that is, start - least - w^2 > 2 w sqrt(least).
  const Dyadic den = start.den * least.den;
  const Dyadic spare = start.num * least.den - least.num * start.den - w * w * den;
  return spare.sign() > 0 && (Dyadic(4) * w * w * least.num * start.den * den - spare * spare).sign() < 0;
}

}  // namespace radar::exact
