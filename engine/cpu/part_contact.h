// When a convex part of a cutter first touches a triangle, in the cutter's frame.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "exact/contact.h"
#include "math/ring_hull.h"

namespace radar::cpu {

/// How a hull moves past triangles that are given in its frame: by t `way`, for t of 0 or more.
struct HullMotion {
  const RingHull& hull;
  Vector way;    ///< not zero
  double drift;  ///< bound on the distance, per t, by which rounding of `way` takes a point astray
};

/// Planes that keep a hull off something, at some of the times. All times are certain.
class FreeTimes {
 public:
  double until() const { return until_; }           ///< none meets before this; infinite: nor ever
  const Vector& normal() const { return normal_; }  ///< of the plane that tells so; 0: none does
  bool isFreeUntil(double t) const { return until_ > t || until_ >= after_; }

  /// A plane across `n`, from the hull towards the other, at the start farther by `least` along n than the frame's
  /// origin; the other is within it but for `error`, a distance.
  void add(const HullMotion& motion, const Vector& n, double least, double error);
  /// The same for a triangle whose corners are off by at most `error` each.
  void add(const HullMotion& motion, const Vector& n, const exact::Triangle& corners, double error) {
    add(motion, n, std::min({dot(n, corners[0]), dot(n, corners[1]), dot(n, corners[2])}), error);
  }

 private:
  double until_ = 0, after_ = std::numeric_limits<double>::infinity();
  Vector normal_{};
};

/// First contact of a hull with a triangle.
struct PartContact {
  double lo, hi;   ///< of t; hi is infinite if rounding leaves contact open; both 0: contact at the start
  Vector weights;  ///< of the corners: their mean is the point that touches, or is inside; NaN if hi is infinite
  Vector normal;   ///< from the hull to the triangle, of length 1; NaN if none is known
};

/// None if the triangle certainly is not met until t = `latest`. Its corners are off by at most `error` each.
std::optional<PartContact> contactOf(const HullMotion& motion, const exact::Triangle& corners, double error,
                                     double latest);

}  // namespace radar::cpu
