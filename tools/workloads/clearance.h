// Which places in a scene are free, by bounding spheres: enough to put sensors where a sweep is worth asking.
#pragma once

#include <unordered_map>
#include <vector>

#include "workloads/random.h"

namespace radar::tools {

/// Spheres in a grid of cells; a cell should be about twice the radius of a large sphere.
class Clearance {
 public:
  explicit Clearance(double cell) : cell_(cell) {}

  void add(const Vec3& centre, double radius);
  /// Whether a sphere touches none of those added.
  bool isFree(const Vec3& centre, double radius) const;

 private:
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  int64_t cellOf(double coordinate) const;
  static uint64_t keyOf(int64_t x, int64_t y, int64_t z);

  double cell_;
  double largest_ = 0;
  std::unordered_map<uint64_t, std::vector<Sphere>> cells_;
};

bool spheresTouch(const Vec3& a, double radiusA, const Vec3& b, double radiusB);

}  // namespace radar::tools
