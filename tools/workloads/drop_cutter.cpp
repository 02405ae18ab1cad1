#include "workloads/drop_cutter.h"

#include <vector>

#include "workloads/shapes.h"

namespace radar::tools {

namespace {

constexpr double kWidth = 100, kRadius = 3;

/// A smooth function of the plane: random heights at whole numbers, blended.
class Hills {
 public:
  Hills(uint32_t size, Random& random) : size_(size), heights_(size_t{size} * size) {
    for (double& height : heights_) height = random.uniform(0, 1);
  }

  /// x and y in [0, size - 1).
  double at(double x, double y) const {
    const auto column = static_cast<uint32_t>(x), row = static_cast<uint32_t>(y);
    const double u = blend(x - column), v = blend(y - row);
    const double* h = &heights_[size_t{row} * size_ + column];
    return (1 - v) * ((1 - u) * h[0] + u * h[1]) + v * ((1 - u) * h[size_] + u * h[size_ + 1]);
  }

 private:
  static double blend(double t) { return t * t * (3 - 2 * t); }
  uint32_t size_;
  std::vector<double> heights_;
};

MeshData relief(uint32_t cells, Random& random) {
  const Hills broad(7, random), fine(40, random);
  MeshData mesh{"relief", {}, {}};
  for (uint32_t row = 0; row <= cells; ++row) {
    for (uint32_t column = 0; column <= cells; ++column) {
      const double x = double(column) / cells, y = double(row) / cells;
      const double height = 10 * broad.at(5.9 * x, 5.9 * y) + 2 * fine.at(38.9 * x, 38.9 * y);
      for (const double value : {kWidth * (x - 0.5), kWidth * (y - 0.5), height}) {
        mesh.positions.push_back(static_cast<float>(value));
      }
    }
  }
  for (uint32_t row = 0; row < cells; ++row) {
    for (uint32_t column = 0; column < cells; ++column) {
      const uint32_t a = row * (cells + 1) + column, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
  }
  return mesh;
}

}  // namespace

Workload makeWorkload(const DropCutter& options) {
  Random random(options.seed);
  Workload workload;
  workload.meshes = {makeUvSphere(16, 64), relief(options.cells, random)};
  workload.meshes[0].name = "ball cutter";
  workload.scenes.push_back({"part", {}, {{1, {}}}, {}});
  for (uint32_t row = 0; row < options.rows; ++row) {
    for (uint32_t column = 0; column < options.columns; ++column) {
      QuerySpec query;
      query.id = "point/" + std::to_string(row) + "/" + std::to_string(column);
      const double x = kWidth * ((column + 0.5) / options.columns - 0.5),
                   y = kWidth * ((row + 0.5) / options.rows - 0.5);
      query.sensor = {0, {{kRadius, 0, 0, x, 0, kRadius, 0, y, 0, 0, kRadius, 20}}};
      query.direction = {0, 0, -1};
      query.distance = 20;
      workload.queries.push_back(std::move(query));
    }
  }
  return workload;
}

}  // namespace radar::tools
