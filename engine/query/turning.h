// Motions that turn: a point p moves along x(s) = p + displacement(p, s), for s from 0 to 1.
#pragma once

#include "math/vector.h"
#include "radar/query.h"

namespace radar {

/// `v`, which is not zero, at length 1, off by at most 6u; components that differ by a factor of 2^1000 lose the lesser
/// ones.
Vector unitOf(const Vector& v);

/// x(s) = centre + s way + R(axis / |axis|, s angle) (p - centre): centre and way are not rounded, nor is angle.
class Turning {
 public:
  /// Of a valid query that turns by some angle.
  explicit Turning(const Query& query);

  const Vector& axis() const { return axis_; }  ///< of length 1, off by at most 6u
  const Vector& centre() const { return centre_; }
  const Vector& way() const { return way_; }
  double angle() const { return angle_; }  ///< not negative
  /// How far p is from the axis at the start; off by rounding.
  double radius(const Vector& p) const;

  /// A point's circle about the axis: R takes it by these, times the sine and 1 - cosine of Angle.
  struct Circle {
    Vector across, inwards;
  };
  struct Angle {
    double side, back;
  };
  Circle circleOf(const Vector& p) const { return circleAbout(minus(p, centre_)); }
  Angle angleAt(double s) const;
  static Vector by(const Circle& circle, const Angle& angle, double s, const Vector& way) {
    return along(along(scaled(angle.side, circle.across), angle.back, circle.inwards), s, way);
  }
  /// How far p has moved by s. `way`: instead of way(). Each component is off by at most errorFor(), for an `arm` of at
  /// least |p - centre|.
  Vector displacement(const Vector& p, double s, const Vector& way) const {
    return by(circleOf(p), angleAt(s), s, way);
  }
  double errorFor(double arm, const Vector& way) const;
  /// Of a mesh that is placed by `start` at the start: takes each vertex to start plus displacement, but for that
  /// error, an `arm` being at least what the terms of a vertex's place add up to, and roundings of the place itself.
  Transform pose(const Transform& start, double s, const Vector& way) const;

 private:
  Circle circleAbout(const Vector& r) const;

  Vector axis_, centre_, way_;
  double angle_;
};

/// Whether the query's motion turns; else, if it has a turn, it is a step.
inline bool turns(const Query& query) {
  return query.turn && query.turn->angle != 0;
}

}  // namespace radar
