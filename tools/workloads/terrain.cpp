// The workloads whose scene is a relief: heights over a square.
#include <algorithm>

#include "workloads/drop_cutter.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

/// Between the heights h[0], h[1] of one row and h[stride], h[stride + 1] of the next.
double between(const double* h, size_t stride, double u, double v) {
  return (1 - v) * ((1 - u) * h[0] + u * h[1]) + v * ((1 - u) * h[stride] + u * h[stride + 1]);
}

std::vector<double> randomHeights(uint32_t side, double least, double most, Random& random) {
  std::vector<double> heights(size_t{side} * side);
  for (double& height : heights) height = random.uniform(least, most);
  return heights;
}

/// A city: hills, and blocks of buildings with streets between them. Heights over a square of `side` x `side` cells of
/// half a unit, centred at the origin. Blocks are 16 units apart, buildings up to 20 high, walls as steep as one cell
/// allows.
class City {
 public:
  City(uint32_t side, Random& random) : side_(side) {
    // A block, in cells: a street of 8, then a building of 24.
    constexpr uint32_t kBlock = 32, kStreet = 8;
    const uint32_t blocks = side / kBlock + 2;
    const std::vector<double> hills = randomHeights(blocks, 0, 6, random);
    const std::vector<double> buildings = randomHeights(blocks, 1, 20, random);
    for (uint32_t row = 0; row <= side; ++row) {
      for (uint32_t column = 0; column <= side; ++column) {
        const size_t block = size_t{row / kBlock} * blocks + column / kBlock;
        const uint32_t x = column % kBlock, y = row % kBlock;
        const double ground = between(&hills[block], blocks, double(x) / kBlock, double(y) / kBlock);
        const double rough = random.uniform(0, 0.2);
        const bool built = x >= kStreet && y >= kStreet;
        heights_.push_back(static_cast<float>(ground + rough + (built ? buildings[block] : 0)));
      }
    }
  }

  MeshData mesh() const {
    const auto vertex = [&](uint32_t column, uint32_t row) {
      return Vec3{kCell * column - halfSide(), kCell * row - halfSide(), heightAt(column, row)};
    };
    return named("city", makeGrid(side_, Diagonal::rising, vertex));
  }

  /// The greatest height whose x and y are both within `radius` of a place.
  double highestNear(double x, double y, double radius) const {
    const auto cell = [&](double where) {
      return static_cast<uint32_t>(std::clamp((where + halfSide()) / kCell, 0.0, double(side_)));
    };
    const uint32_t lastColumn = std::min(cell(x + radius) + 1, side_), lastRow = std::min(cell(y + radius) + 1, side_);
    double highest = -INFINITY;
    for (uint32_t row = cell(y - radius); row <= lastRow; ++row) {
      for (uint32_t column = cell(x - radius); column <= lastColumn; ++column) {
        highest = std::max(highest, heightAt(column, row));
      }
    }
    return highest;
  }

  double halfSide() const { return 0.5 * kCell * side_; }

 private:
  static constexpr double kCell = 0.5;
  double heightAt(uint32_t column, uint32_t row) const { return heights_[size_t{row} * (side_ + 1) + column]; }

  uint32_t side_;
  std::vector<float> heights_;  ///< of the cells' corners, by row
};

constexpr double kReliefWidth = 100, kBallRadius = 3;

/// A smooth function of the plane: random heights at whole numbers, blended.
class Hills {
 public:
  Hills(uint32_t size, Random& random) : size_(size), heights_(randomHeights(size, 0, 1, random)) {}

  /// x and y in [0, size - 1).
  double at(double x, double y) const {
    const auto column = static_cast<uint32_t>(x), row = static_cast<uint32_t>(y);
    return between(&heights_[size_t{row} * size_ + column], size_, blend(x - column), blend(y - row));
  }

 private:
  static double blend(double t) { return t * t * (3 - 2 * t); }
  uint32_t size_;
  std::vector<double> heights_;
};

MeshData relief(uint32_t cells, Random& random) {
  const Hills broad(7, random), fine(40, random);
  const auto vertex = [&](uint32_t column, uint32_t row) {
    const double x = double(column) / cells, y = double(row) / cells;
    const double height = 10 * broad.at(5.9 * x, 5.9 * y) + 2 * fine.at(38.9 * x, 38.9 * y);
    return Vec3{kReliefWidth * (x - 0.5), kReliefWidth * (y - 0.5), height};
  };
  return named("relief", makeGrid(cells, Diagonal::rising, vertex));
}

}  // namespace

Workload makeWorkload(const OneMesh& options) {
  Random random(options.seed), sensorRandom(options.seed + 1'000'003);
  const City city(static_cast<uint32_t>(std::sqrt(0.5 * options.triangles)), random);
  Workload workload;
  workload.meshes = {makeBox(kFull), makeTeapot(), city.mesh()};
  workload.scenes.push_back({"city", {}, {{2, {}}}, {}});
  addSensors(workload, sensorRandom, options.sensors, options.shape, [&](double radius) {
    const double edge = city.halfSide();
    Vec3 where = sensorRandom.inBox({-edge, -edge, 0.5}, {edge, edge, 6});
    where[2] += radius + city.highestNear(where[0], where[1], radius);
    return where;
  });
  return workload;
}

Workload makeWorkload(const DropCutter& options) {
  Random random(options.seed);
  Workload workload;
  workload.meshes = {named("ball cutter", makeUvSphere(16, 64)), relief(options.cells, random)};
  workload.scenes.push_back({"part", {}, {{1, {}}}, {}});
  for (uint32_t row = 0; row < options.rows; ++row) {
    for (uint32_t column = 0; column < options.columns; ++column) {
      QuerySpec query;
      query.id = "point/" + std::to_string(row) + "/" + std::to_string(column);
      const double x = kReliefWidth * ((column + 0.5) / options.columns - 0.5),
                   y = kReliefWidth * ((row + 0.5) / options.rows - 0.5);
      query.setSensor({0, makePose(kUpright, kBallRadius * kFull, {x, y, 20})});
      query.direction = {0, 0, -1};
      query.distance = 20;
      workload.queries.push_back(std::move(query));
    }
  }
  return workload;
}

}  // namespace radar::tools
