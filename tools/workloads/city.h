// One mesh as large as a city: hills, and blocks of buildings with streets between them.
#pragma once

#include <cstdint>
#include <vector>

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Heights over a square of `side` x `side` cells of half a unit, centred at the origin, z up. Blocks are 16 units
/// apart, buildings up to 20 high, walls as steep as one cell allows. The same arguments give the same bits everywhere.
class City {
 public:
  City(uint32_t side, Random& random);

  /// Two triangles a cell.
  MeshData mesh() const;
  /// Of all ground within `radius` of a place, across x and y alike.
  double highestNear(double x, double y, double radius) const;
  /// Half the length of the square's edge.
  double halfSide() const { return 0.5 * kCell * side_; }

 private:
  static constexpr double kCell = 0.5;
  float& height(uint32_t column, uint32_t row) { return heights_[size_t{row} * (side_ + 1) + column]; }

  uint32_t side_;
  std::vector<float> heights_;  ///< of the cells' corners, by row
};

}  // namespace radar::tools
