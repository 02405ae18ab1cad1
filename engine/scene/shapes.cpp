#include "radar/shapes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/number_text.h"

namespace radar {

namespace {

void requireRadius(const char* call, double radius) {
  if (radius >= 0 && radius <= 0x1p1000) return;
  throw Error(std::string(call) + ": radius: expected a number from 0 to 2^1000, got " + textOf(radius));
}

}  // namespace

RoundShape ball(double radius) {
  requireRadius("ball", radius);
  return {.positions = {0, 0, 0}, .indices = {0, 0, 0}, .radius = radius};
}

RoundShape capsule(const std::array<float, 3>& from, const std::array<float, 3>& to, double radius) {
  requireRadius("capsule", radius);
  RoundShape shape{
      .positions = {from[0], from[1], from[2], to[0], to[1], to[2]}, .indices = {0, 1, 1}, .radius = radius};
  if (!std::ranges::all_of(shape.positions, [](float x) { return std::isfinite(x); })) {
    throw Error("capsule: expected two points of finite numbers");
  }
  return shape;
}

RoundShape rounded(std::span<const float> positions, std::span<const uint32_t> indices, double radius) {
  requireRadius("rounded", radius);
  return {{positions.begin(), positions.end()}, {indices.begin(), indices.end()}, radius};
}

}  // namespace radar
