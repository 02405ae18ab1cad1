#include "query/turning.h"

#include <cmath>

#include "math/rounding.h"

namespace radar {

Vector unitOf(const Vector& v) {
  const int exponent = std::ilogb(largest(v));
  Vector out;
  for (int k = 0; k < 3; ++k) out[k] = std::scalbn(v[k], -exponent);
  return scaled(1 / std::sqrt(dot(out, out)), out);
}

Turning::Turning(const Query& query)
    : axis_(unitOf(query.turn->axis)),
      centre_(query.turn->centre),
      way_(query.motion.value_or(Vector{})),
      angle_(std::abs(query.turn->angle)) {
  if (query.turn->angle < 0) axis_ = scaled(-1, axis_);
}

double Turning::radius(const Vector& p) const {
  const Vector side = cross(axis_, minus(p, centre_));
  return std::hypot(side[0], side[1], side[2]);
}

// 1 - cos as 2 sin^2, so that tiny angles lose nothing.
Turning::Angle Turning::angleAt(double s) const {
  const double by = s * angle_, half = std::sin(0.5 * by);
  return {std::sin(by), 2 * half * half};
}

Turning::Circle Turning::circleAbout(const Vector& r) const {
  const Vector across = cross(axis_, r);
  return {across, cross(axis_, across)};
}

// With u = 2^-53 and w = s angle: r = p - centre is off by u |r|; the axis by 6u; across by 13u |r| and inwards by 25u
// |r|; the sine, of a rounded angle and itself off by up to an ulp, by u (|w| + 2 min(1, |w|)), and back, by 8u |w|, is
// at most 2 min(1, |w|). So the turn is off by u |w| |r| (13 + 50 + 3 + 8), and by 3u of its sums, which are at most 3
// |w| |r|.
double Turning::errorFor(double arm, const Vector& way) const {
  return 128 * kUnit * (arm * angle_ + norm1(way)) + 0x1p-1000;
}

Transform Turning::pose(const Transform& start, double s, const Vector& way) const {
  Transform out = start;
  const auto add = [&](int column, const Vector& moved) {
    for (int i = 0; i < 3; ++i) out.m[4 * i + column] += moved[i];
  };
  const Angle angle = angleAt(s);
  for (int k = 0; k < 3; ++k) add(k, by(circleAbout({start.m[k], start.m[4 + k], start.m[8 + k]}), angle, 0, way));
  add(3, by(circleOf({start.m[3], start.m[7], start.m[11]}), angle, s, way));
  return out;
}

}  // namespace radar
