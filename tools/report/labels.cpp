#include "report/labels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace radar::tools {

namespace {

double overlap(const Box& a, const Box& b) {
  const double across = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double down = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return across > 0 && down > 0 ? across * down : 0;
}

constexpr double kNear = 8;

// Around the spot, nearer places before farther.
std::vector<Box> boxesBeside(const Spot& spot, double width, double height, double reach) {
  const std::array<Spot, 10> corners{{{reach, -0.5 * height},
                                      {-0.5 * width, -reach - height},
                                      {-0.5 * width, reach},
                                      {-reach - width, -0.5 * height},
                                      {reach, -reach - height},
                                      {reach, reach},
                                      {-reach - width, -reach - height},
                                      {-reach - width, reach},
                                      {kNear, -0.5 * height - reach},
                                      {kNear, -0.5 * height + reach}}};
  std::vector<Box> boxes;
  boxes.reserve(corners.size());
  for (const auto& [x, y] : corners) {
    boxes.push_back({spot.x + x, spot.y + y, spot.x + x + width, spot.y + y + height});
  }
  return boxes;
}

}  // namespace

void LabelPlaces::takeLine(const Spot& from, const Spot& to) {
  constexpr double kStep = 4, kHalf = 1.5;
  const double dx = to.x - from.x, dy = to.y - from.y, steps = std::ceil(std::hypot(dx, dy) / kStep);
  for (double i = 0; i < steps; ++i) {
    const double x = from.x + dx * i / steps, y = from.y + dy * i / steps;
    take({x - kHalf, y - kHalf, x + kHalf, y + kHalf});
  }
}

double LabelPlaces::cost(const Box& box) const {
  constexpr double kOutside = 4;  // worse than standing on something
  double sum = kOutside * ((box.right - box.left) * (box.bottom - box.top) - overlap(box, inside_));
  for (const Box& other : taken_) sum += overlap(box, other);
  return sum;
}

std::optional<LabelPlaces::Place> LabelPlaces::placeBeside(const std::vector<Spot>& spots, double width, double height,
                                                           double most) {
  constexpr double kFarther = 20;
  double best = INFINITY;
  Place where;
  for (auto spot = spots.rbegin(); spot != spots.rend(); ++spot) {
    for (const double far : {1.0, 1.5, 2.5, 4.0}) {
      for (const Box& box : boxesBeside(*spot, width, height, kNear * far)) {
        const double price = cost(box) + kFarther * (far - 1);
        if (price >= best) continue;
        best = price;
        where = {box, *spot};
      }
    }
  }
  if (best > most) return std::nullopt;
  take(where.box);
  return where;
}

}  // namespace radar::tools
