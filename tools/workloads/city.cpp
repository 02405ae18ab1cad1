#include "workloads/city.h"

#include <algorithm>
#include <cmath>

namespace radar::tools {

namespace {

// A block, in cells: a street of 8, then a building of 24.
constexpr uint32_t kBlock = 32, kStreet = 8;

}  // namespace

City::City(uint32_t side, Random& random) : side_(side), heights_((size_t{side} + 1) * (side + 1)) {
  const uint32_t blocks = side / kBlock + 2;
  std::vector<double> hills(size_t{blocks} * blocks), buildings(hills.size());
  for (double& height : hills) height = random.uniform(0, 6);
  for (double& height : buildings) height = random.uniform(1, 20);
  for (uint32_t row = 0; row <= side; ++row) {
    for (uint32_t column = 0; column <= side; ++column) {
      const uint32_t x = column / kBlock, y = row / kBlock;
      const double u = double(column % kBlock) / kBlock, v = double(row % kBlock) / kBlock;
      const double* hill = &hills[size_t{y} * blocks + x];
      const double ground =
          (1 - v) * ((1 - u) * hill[0] + u * hill[1]) + v * ((1 - u) * hill[blocks] + u * hill[blocks + 1]);
      const bool built = column % kBlock >= kStreet && row % kBlock >= kStreet;
      const double rough = random.uniform(0, 0.2);
      height(column, row) = static_cast<float>(ground + rough + (built ? buildings[size_t{y} * blocks + x] : 0));
    }
  }
}

MeshData City::mesh() const {
  MeshData mesh{"city", {}, {}};
  mesh.positions.reserve(3 * heights_.size());
  mesh.indices.reserve(6 * size_t{side_} * side_);
  const auto corner = [&](uint32_t column, uint32_t row) { return row * (side_ + 1) + column; };
  for (uint32_t row = 0; row <= side_; ++row) {
    for (uint32_t column = 0; column <= side_; ++column) {
      const auto x = static_cast<float>(kCell * column - halfSide()), y = static_cast<float>(kCell * row - halfSide());
      mesh.positions.insert(mesh.positions.end(), {x, y, heights_[corner(column, row)]});
    }
  }
  for (uint32_t row = 0; row < side_; ++row) {
    for (uint32_t column = 0; column < side_; ++column) {
      const uint32_t a = corner(column, row), b = a + 1, c = corner(column, row + 1), d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
  }
  return mesh;
}

double City::highestNear(double x, double y, double radius) const {
  const auto cell = [&](double at) {
    return static_cast<uint32_t>(std::clamp((at + halfSide()) / kCell, 0.0, double(side_)));
  };
  const uint32_t lastColumn = std::min(cell(x + radius) + 1, side_), lastRow = std::min(cell(y + radius) + 1, side_);
  double highest = -1e300;
  for (uint32_t row = cell(y - radius); row <= lastRow; ++row) {
    for (uint32_t column = cell(x - radius); column <= lastColumn; ++column) {
      highest = std::max<double>(highest, heights_[size_t{row} * (side_ + 1) + column]);
    }
  }
  return highest;
}

}  // namespace radar::tools
