// Milling cutters as exact solids of revolution, without tessellation. A cutter stands on the origin of its frame, its
// axis along z, and consists of convex parts: the cutting end, shanks, holders.
//
//   radar::Cutter tool = radar::bullNoseCutter(3, 0.5, 20);
//   tool.parts.push_back({{20, 4}, {50, 4}});   // a shank
//   tool.parts.push_back({{50, 12}, {80, 20}});  // a holder that widens upwards
//   const radar::Query query{.mesh = scene.addCutter(tool), .worldFromMesh = above, .direction = {0, 0, -1}, .distance
//   = 9};
#pragma once

#include <vector>

#include "radar/error.h"

namespace radar {

/// A circle around the z axis, rounded by a ball: all points that are no farther from it than `corner`.
struct Ring {
  double height = 0;  ///< of the circle
  double radius = 0;  ///< of the circle; 0: a point
  double corner = 0;  ///< of the ball; 0: the circle itself
};

struct Cutter {
  std::vector<std::vector<Ring>>
      parts{};  ///< each is the convex hull of its rings, in any order; [0] is the cutting end
};

// With their tips at the origin. All throw Error unless their numbers are finite, above 0 and as said.

/// A cylinder.
RADAR_API Cutter flatCutter(double radius, double length);
/// A ball, and a cylinder up to `length`, which is at least twice the radius.
RADAR_API Cutter ballCutter(double radius, double length);
/// A cylinder whose lower rim is rounded by `corner`, which is at most the radius and half the length.
RADAR_API Cutter bullNoseCutter(double radius, double corner, double length);
/// A cone, and a cylinder up to `length`, where the cone ends at the latest. `angle`, radians, below pi/2: between the
/// axis and the side. `tipRadius`: of the flat tip, less than `radius`; may be 0.
RADAR_API Cutter coneCutter(double radius, double angle, double length, double tipRadius = 0);
/// A ball of `tipRadius`, above it a cone that touches it, as of coneCutter, and a cylinder up to `length`, above both.
RADAR_API Cutter taperCutter(double radius, double angle, double tipRadius, double length);

}  // namespace radar
