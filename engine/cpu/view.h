// The frame in which pairs of triangles are filtered. Its origin is at the sensor; its axes are two across the motion
// and the motion itself; its unit is about the sensor's size.
#pragma once

#include "exact/contact.h"
#include "exact/motion.h"

namespace radar::cpu {

struct View {
  Vector origin;
  double scale;  ///< view units per world unit, a power of two
  std::array<Vector, 3> axes;

  /// `size`: the sensor's approximate size, world units.
  View(const Vector& sensor, double size, const Vector& unit);
};

/// A placed triangle, in the view's frame.
struct ViewedTriangle {
  std::array<Vector, 3> corners;
  Vector lo, hi;           ///< their box, widened by `error`
  double error;            ///< bound on the rounding error of each coordinate; not finite: unknown
  double area, areaError;  ///< twice the signed area, projected along the motion; bound on its error

  ViewedTriangle(const exact::Triangle& world, const View& view);
};

}  // namespace radar::cpu
