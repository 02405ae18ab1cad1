// Seeded triangle soups for the tests of the exact search, and the comparison with the oracle.
#pragma once

#include <random>

#include "brute_force.h"
#include "support/answer.h"
#include "support/catch.h"

namespace soups {

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * std::generate_canonical<double, 53>(engine_); }
  int integer(int lo, int hi) { return lo + static_cast<int>(engine_() % static_cast<uint64_t>(hi - lo + 1)); }
  bool chance(double p) { return uniform(0, 1) < p; }
  std::array<double, 3> inBall();
  radar::Transform pose(double scale, const std::array<double, 3>& at);

 private:
  std::mt19937_64 engine_;
};

inline std::array<double, 3> Random::inBall() {
  for (;;) {
    const std::array<double, 3> v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (square <= 1 && square > 1e-3) return v;
  }
}

inline radar::Transform Random::pose(double scale, const std::array<double, 3>& at) {
  double q[4], square = 0;
  do {
    square = 0;
    for (double& c : q) {
      c = uniform(-1, 1);
      square += c * c;
    }
  } while (square > 1 || square < 1e-3);
  const double length = std::sqrt(square);
  const double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
  radar::Transform pose;
  pose.m = {
      scale * (1 - 2 * (y * y + z * z)), scale * 2 * (x * y - z * w),       scale * 2 * (x * z + y * w),       at[0],
      scale * 2 * (x * y + z * w),       scale * (1 - 2 * (x * x + z * z)), scale * 2 * (y * z - x * w),       at[1],
      scale * 2 * (x * z - y * w),       scale * 2 * (y * z + x * w),       scale * (1 - 2 * (x * x + y * y)), at[2]};
  return pose;
}

/// Triangles of size about `size` in a ball of radius 1; some needles and some degenerate ones.
inline Mesh soup(Random& random, int triangles, double size, double odd) {
  Mesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const auto centre = random.inBall();
    std::array<std::array<double, 3>, 3> c;
    for (auto& corner : c) {
      const auto offset = random.inBall();
      for (int k = 0; k < 3; ++k) corner[k] = centre[k] + size * offset[k];
    }
    if (random.chance(odd)) {
      const int kind = random.integer(0, 3);
      if (kind == 0) c[1] = c[0];         // a segment
      if (kind == 1) c[2] = c[1] = c[0];  // a point
      for (int k = 0; k < 3; ++k) {
        if (kind == 2) c[2][k] = c[0][k] + 1e-5 * (c[2][k] - c[0][k]);        // a needle
        if (kind == 3) c[2][k] = 0.5 * (c[0][k] + c[1][k]) + 1e-6 * c[2][k];  // a sliver
      }
    }
    for (const auto& corner : c) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size() / 3));
      for (double v : corner) mesh.positions.push_back(static_cast<float>(v));
    }
  }
  return mesh;
}

/// Triangles with integer corners in [0, side]: everything is degenerate, parallel, equal or touching.
inline Mesh lattice(Random& random, int triangles, int side) {
  Mesh mesh;
  for (int i = 0; i < 3 * triangles; ++i) {
    mesh.indices.push_back(static_cast<uint32_t>(i));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(random.integer(0, side)));
  }
  return mesh;
}

/// A box with corners at +-half.
inline Mesh box(double x, double y, double z) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.positions.push_back(static_cast<float>(k & 1 ? x : -x));
    mesh.positions.push_back(static_cast<float>(k & 2 ? y : -y));
    mesh.positions.push_back(static_cast<float>(k & 4 ? z : -z));
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

inline radar::Transform at(double x, double y, double z) {
  radar::Transform pose;
  pose.m[3] = x;
  pose.m[7] = y;
  pose.m[11] = z;
  return pose;
}

inline radar::MeshId add(radar::Scene& scene, const Mesh& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

/// Distance from `p` to a triangle, which may be degenerate.
inline double distance(const std::array<double, 3>& p, const oracle::Corners& t) {
  using V = std::array<double, 3>;
  const auto minus = [](const V& x, const V& y) { return V{x[0] - y[0], x[1] - y[1], x[2] - y[2]}; };
  const auto dot = [](const V& x, const V& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
  const auto cross = [](const V& x, const V& y) {
    return V{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  };
  const auto unit = [&](V v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    for (double& c : v) c /= length;
    return v;
  };
  double best = INFINITY;
  for (size_t i = 0; i < 3; ++i) {
    const V edge = minus(t[(i + 1) % 3], t[i]), to = minus(p, t[i]);
    const double length = std::hypot(edge[0], edge[1], edge[2]);
    const V along = length > 0 ? unit(edge) : V{};
    const double at = std::clamp(dot(along, to), 0.0, length);
    const V rest{to[0] - at * along[0], to[1] - at * along[1], to[2] - at * along[2]};
    best = std::min(best, std::hypot(rest[0], rest[1], rest[2]));
  }
  const V n = unit(cross(minus(t[1], t[0]), minus(t[2], t[0])));
  bool inside = true;
  for (size_t i = 0; i < 3; ++i) {
    inside = inside && dot(n, cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i]))) >= 0;
  }
  return inside ? std::min(best, std::abs(dot(n, minus(p, t[0])))) : best;
}

/// Checks that the point lies on both triangles at the moment of contact and the normal is a unit vector against the
/// motion.
inline void checkContact(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
  const radar::Object& object = scene.object(result.object);
  const oracle::Corners b = oracle::corners(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
  oracle::Corners a = oracle::corners(scene.mesh(query.mesh), query.worldFromMesh, result.triA);
  const auto& d = query.direction;
  const double length = std::hypot(d[0], d[1], d[2]);
  double size = 0;
  for (auto& corner : a) {
    for (size_t k = 0; k < 3; ++k) {
      size = std::max({size, std::abs(corner[k]), result.t});
      corner[k] += result.t * (d[k] / length);
    }
  }
  for (const auto& corner : b) {
    for (double c : corner) size = std::max(size, std::abs(c));
  }
  if (!std::isnan(result.point[0])) {
    REQUIRE(distance(result.point, a) <= 1e-13 * size);
    REQUIRE(distance(result.point, b) <= 1e-13 * size);
  } else {
    REQUIRE(result.status == radar::Status::overlap);
  }
  const auto& n = result.normal;
  if (std::isnan(n[0])) return;
  REQUIRE(std::abs(std::hypot(n[0], n[1], n[2]) - 1) <= 1e-15);
  REQUIRE(n[0] * d[0] + n[1] * d[1] + n[2] * d[2] <= 1e-15 * length);
}

/// Checks the status, the pair and the bracket of an answer.
inline void checkTruth(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
  const oracle::Truth truth = oracle::truthOf(scene, query);
  const std::string fault = oracle::faultOf(truth.contacts.empty() ? nullptr : &truth.contacts[0], query, result);
  INFO(fault);
  REQUIRE(fault.empty());
}

/// Checks everything that the oracle knows about an answer.
inline void check(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
  REQUIRE(result.tier == radar::Tier::reference);
  checkTruth(scene, query, result);
  if (result.status == radar::Status::clear) {
    REQUIRE(result.t == std::numeric_limits<double>::infinity());
    return;
  }
  if (result.status == radar::Status::overlap) REQUIRE(result.t == 0);
  checkContact(scene, query, result);
}

}  // namespace soups
