// The frame in which pairs of triangles are sorted out: its origin at the sensor, two axes across the motion and the
// motion itself, and the sensor is about as large as its unit.
#pragma once

#include "cpu/motion.h"

namespace radar::cpu {

struct View {
  Vector origin;
  double scale;  ///< of world units, a power of two
  std::array<Vector, 3> axes;

  /// `size`: of the sensor, in the world, roughly.
  View(const Vector& sensor, double size, const Vector& unit);
};

/// A triangle placed in the world, as the view sees it.
struct ViewedTriangle {
  std::array<Vector, 3> corners;
  Vector lo, hi;           ///< their box, widened by `error`
  double error;            ///< bounds what rounding did to each coordinate of each corner; not finite: nothing is known
  double area, areaError;  ///< of the triangle seen along the motion, signed, twice; bound on its error

  ViewedTriangle(const exact::Triangle& world, const View& view);
};

}  // namespace radar::cpu
