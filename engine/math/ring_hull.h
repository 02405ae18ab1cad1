// Convex solids of revolution: hulls of circles around the z axis, each rounded by a ball.
#pragma once

#include <span>
#include <vector>

#include "math/vector.h"
#include "radar/cutters.h"

namespace radar {

/// All roundings are below 16u of the numbers involved: the point's coordinates, size(), the normal's length.
class RingHull {
 public:
  /// Of one ring or more, finite; `room` is added to their corners.
  explicit RingHull(std::span<const Ring> rings, double room = 0);

  /// The greatest n . x of all its points, and the ring that attains it.
  double support(const Vector& n) const { return support(n, ringAlong(n)); }
  size_t ringAlong(const Vector& n) const;
  /// The farthest point of a ring along n; of a circle across n, its centre.
  Vector farthest(size_t ring, const Vector& n) const;

  /// How far a point is from the surface, below 0 inside, and the surface's unit normal there.
  struct Foot {
    double distance;
    Vector normal;
  };
  Foot footOf(const Vector& p) const;

  /// A flat end or the straight side between two rings, seen in the half plane of radius and height.
  struct Side {
    double outwards, up;  ///< its unit normal
    double at;            ///< the normal's inner product with its points
    size_t lower, upper;  ///< rings
  };
  /// From the bottom, which has a lower and upper ring of its own, to the top; some are of no extent. Between two
  /// follows the rounded edge of the ring in which they meet.
  const std::vector<Side>& sides() const { return sides_; }
  const std::vector<Ring>& rings() const { return rings_; }
  double size() const { return size_; }      ///< no coordinate is greater
  double middle() const { return middle_; }  ///< the height of a point inside

 private:
  double support(const Vector& n, size_t ring) const;

  std::vector<Ring> rings_;
  std::vector<Side> sides_;
  double size_ = 0, middle_ = 0;
};

}  // namespace radar
