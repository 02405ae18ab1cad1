#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "math/number_text.h"
#include "scene/scene.h"

namespace radar {

namespace {

// Floats hold the drawn mesh, and doubles products of what is searched.
constexpr double kMostLength = 0x1p100;
// Of the drawn mesh: around the axis, and in a quarter of a rounded edge.
constexpr uint32_t kAround = 32, kInEdge = 8;

void require(bool isRight, const char* call, const std::string& expected, double got) {
  if (!isRight) throw Error(std::string(call) + ": " + expected + ", got " + textOf(got));
}

void requireLength(const char* call, const char* what, double value) {
  require(value > 0 && value <= kMostLength, call, std::string(what) + ": expected a number above 0, at most 2^100",
          value);
}

// Of a cone around the axis, above `foot`, that becomes as wide as `radius`.
void requireCone(const char* call, double radius, double angle, double tipRadius, double length) {
  requireLength(call, "radius", radius);
  requireLength(call, "length", length);
  require(angle > 0 && angle < std::numbers::pi / 2, call, "angle: expected radians between 0 and pi/2", angle);
  require(tipRadius >= 0 && tipRadius < radius, call, "tipRadius: expected 0 or more, less than the radius", tipRadius);
}

}  // namespace

Cutter flatCutter(double radius, double length) {
  requireLength("flatCutter", "radius", radius);
  requireLength("flatCutter", "length", length);
  return {{{{0, radius}, {length, radius}}}};
}

Cutter bullNoseCutter(double radius, double corner, double length) {
  requireLength("bullNoseCutter", "radius", radius);
  requireLength("bullNoseCutter", "corner", corner);
  require(corner <= radius, "bullNoseCutter", "corner: expected at most the radius", corner);
  require(length >= 2 * corner && length <= kMostLength, "bullNoseCutter",
          "length: expected at least twice the corner, at most 2^100", length);
  return {{{{corner, radius - corner, corner}, {length, radius}}}};
}

Cutter ballCutter(double radius, double length) {
  requireLength("ballCutter", "radius", radius);
  require(length >= 2 * radius && length <= kMostLength, "ballCutter",
          "length: expected at least twice the radius, at most 2^100", length);
  return bullNoseCutter(radius, radius, length);
}

Cutter coneCutter(double radius, double angle, double length, double tipRadius) {
  requireCone("coneCutter", radius, angle, tipRadius, length);
  const double top = (radius - tipRadius) / std::tan(angle);
  require(length >= top, "coneCutter", "length: expected at least " + textOf(top) + ", where the cone ends", length);
  return {{{{0, tipRadius}, {top, radius}, {length, radius}}}};
}

Cutter taperCutter(double radius, double angle, double tipRadius, double length) {
  requireCone("taperCutter", radius, angle, tipRadius, length);
  requireLength("taperCutter", "tipRadius", tipRadius);
  require(tipRadius < radius * std::cos(angle), "taperCutter",
          "tipRadius: expected less than " + textOf(radius * std::cos(angle)) + ", so that the cone is wider",
          tipRadius);
  const double top = tipRadius + (radius - tipRadius / std::cos(angle)) / std::tan(angle);
  const double least = std::max(top, 2 * tipRadius);
  require(length >= least, "taperCutter",
          "length: expected at least " + textOf(least) + ", where the cone and the ball end", length);
  return {{{{tipRadius, 0, tipRadius}, {top, radius}, {length, radius}}}};
}

std::vector<RingHull> hullsOf(const Cutter& cutter) {
  if (cutter.parts.empty()) throw Error("addCutter: parts: expected one or more");
  std::vector<RingHull> out;
  for (size_t i = 0; i < cutter.parts.size(); ++i) {
    const std::string part = "parts[" + std::to_string(i) + "]";
    double bottom = kMostLength, top = -kMostLength, widest = 0;
    for (size_t k = 0; k < cutter.parts[i].size(); ++k) {
      const Ring& ring = cutter.parts[i][k];
      const std::string at = part + "[" + std::to_string(k) + "]: ";
      require(std::abs(ring.height) <= kMostLength, "addCutter", at + "height: expected at most 2^100", ring.height);
      require(ring.radius >= 0 && ring.radius <= kMostLength, "addCutter", at + "radius: expected 0 to 2^100",
              ring.radius);
      require(ring.corner >= 0 && ring.corner <= kMostLength, "addCutter", at + "corner: expected 0 to 2^100",
              ring.corner);
      bottom = std::min(bottom, ring.height - ring.corner);
      top = std::max(top, ring.height + ring.corner);
      widest = std::max(widest, ring.radius + ring.corner);
    }
    if (!(bottom < top && widest > 0)) throw Error("addCutter: " + part + ": expected rings that span a solid");
    out.emplace_back(cutter.parts[i]);
  }
  return out;
}

DrawnCutter drawn(std::span<const RingHull> hulls) {
  DrawnCutter out;
  for (const RingHull& hull : hulls) {
    std::vector<std::array<double, 2>> outline;  // radius and height, from the bottom's middle to the top's
    outline.push_back({0, -hull.sides().front().at});
    for (size_t i = 0; i + 1 < hull.sides().size(); ++i) {
      const RingHull::Side &before = hull.sides()[i], &after = hull.sides()[i + 1];
      const Ring& ring = hull.rings()[before.upper];
      const double from = std::atan2(before.outwards, -before.up), to = std::atan2(after.outwards, -after.up);
      const double turn = to - from;
      const auto steps =
          ring.corner > 0 ? static_cast<uint32_t>(std::ceil(kInEdge * turn / (std::numbers::pi / 2))) : 0;
      for (uint32_t k = 0; k <= steps; ++k) {
        const double at = steps == 0 ? from : from + turn * k / steps;
        outline.push_back({ring.radius + ring.corner * std::sin(at), ring.height - ring.corner * std::cos(at)});
      }
    }
    outline.push_back({0, hull.sides().back().at});
    const auto first = static_cast<uint32_t>(out.positions.size() / 3);
    for (const auto& [radius, height] : outline) {
      for (uint32_t k = 0; k < kAround; ++k) {
        const double at = 2 * std::numbers::pi * k / kAround;
        for (const double x : {radius * std::cos(at), radius * std::sin(at), height}) {
          out.positions.push_back(static_cast<float>(x));
        }
      }
    }
    for (uint32_t row = 0; row + 1 < outline.size(); ++row) {
      for (uint32_t k = 0; k < kAround; ++k) {
        const uint32_t a = first + row * kAround + k, b = first + row * kAround + (k + 1) % kAround;
        for (const uint32_t corner : {a, b, b + kAround, a, b + kAround, a + kAround}) out.indices.push_back(corner);
      }
    }
  }
  return out;
}

}  // namespace radar
