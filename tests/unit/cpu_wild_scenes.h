// Scenes at the limits of the range of doubles: sizes from 10^-150 to 10^150, far origins, nearly singular poses,
// motions of every length.
#pragma once

#include "soups.h"

namespace wild {

using soups::Random;

/// 10 to a random power between -most and most.
inline double power(Random& random, double most) {
  return std::pow(10.0, random.uniform(-most, most));
}

/// A soup, a lattice or a box with coordinates times `scale`, within the range of floats; sometimes far from its
/// origin, flat, a segment or a point.
inline soups::Mesh mesh(Random& random, double scale) {
  const int kind = random.integer(0, 5);
  soups::Mesh out = kind == 0   ? soups::box(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1))
                    : kind == 1 ? soups::lattice(random, random.integer(1, 8), 3)
                                : soups::soup(random, random.integer(1, 10), random.uniform(0.05, 1), 0.2);
  const double far = random.chance(0.1) ? power(random, 6) : 0;
  const std::array<bool, 3> flat{random.chance(0.05), random.chance(0.05), random.chance(0.05)};
  for (size_t i = 0; i < out.positions.size(); ++i) {
    const double at = flat[i % 3] ? 0.25 : out.positions[i];
    out.positions[i] = static_cast<float>(scale * (at + far));
  }
  return out;
}

inline std::array<double, 9> linearOf(const radar::Transform& pose) {
  const auto& m = pose.m;
  return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
}

/// A rotation, often scaled differently along its axes, sheared, mirrored, or flattened until it is hardly invertible.
inline radar::Transform pose(Random& random, double scale, const std::array<double, 3>& at) {
  for (;;) {
    const std::array<double, 9> p = linearOf(random.pose(1, {})), q = linearOf(random.pose(1, {}));
    std::array<double, 3> stretch{1, 1, 1};
    if (random.chance(0.4)) {
      for (double& s : stretch) s = random.uniform(0.2, 2) * (random.chance(0.2) ? -1 : 1);
    }
    if (random.chance(0.2)) stretch[static_cast<size_t>(random.integer(0, 2))] *= power(random, 11.5);
    double shear = random.chance(0.2) ? power(random, 5) : 0;
    radar::Transform out;
    for (size_t i = 0; i < 3; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (size_t j = 0; j < 3; ++j) sum += p[3 * i + j] * stretch[j] * q[3 * j + k];
        out.m[4 * i + k] = scale * sum;
      }
      out.m[4 * i + 1] += shear * out.m[4 * i];
      out.m[4 * i + 3] = at[i];
    }
    if (random.chance(0.2)) {  // axis-aligned
      out.m = {scale * stretch[0], 0, 0, at[0], 0, scale * stretch[1], 0, at[1], 0, 0, scale * stretch[2], at[2]};
    }
    if (radar::validate(out).empty()) return out;
  }
}

struct Made {
  radar::Scene scene;
  std::vector<radar::Query> queries;
};

/// Sizes range from 10^-most to 10^most.
inline void make(Random& random, double most, Made& out) {
  const double world = power(random, most);
  // A pose scales a mesh of size 10^-30 to 10^30 to about the size of the world, or to a much smaller or larger one.
  const auto size = [&] { return random.chance(0.7) ? random.uniform(0.3, 2) : power(random, 4); };
  std::vector<radar::MeshId> meshes;
  std::vector<double> units;
  for (int m = 0; m < 3; ++m) {
    const double unit = random.chance(0.5) ? 1 : power(random, 30);
    units.push_back(unit);
    meshes.push_back(soups::add(out.scene, mesh(random, unit)));
  }
  std::array<double, 3> centre{};
  if (random.chance(0.4)) {
    const double far = random.chance(0.5) ? power(random, 3) : power(random, 10);
    for (double& c : centre) c = world * far * random.uniform(-1, 1);
  }
  const auto near = [&](double spread) {
    auto p = random.inBall();
    for (size_t k = 0; k < 3; ++k) p[k] = centre[k] + world * spread * p[k];
    return p;
  };
  const auto placed = [&](size_t m, double spread) { return pose(random, world * size() / units[m], near(spread)); };
  for (int i = random.integer(1, 6); i-- > 0;) {
    const auto m = static_cast<size_t>(random.integer(0, 2));
    out.scene.addObject({meshes[m], placed(m, 3), random.chance(0.2) ? 1u : ~0u});
  }
  for (int q = 0; q < 8; ++q) {
    radar::Query query;
    const auto m = static_cast<size_t>(random.integer(0, 2));
    query.mesh = meshes[m];
    query.worldFromMesh = placed(m, random.chance(0.3) ? 0.5 : 4);
    // Most directions point towards an object.
    const auto& pose = out.scene.object(0).worldFromMesh.m;
    for (size_t k = 0; k < 3; ++k) query.direction[k] = pose[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
    double length = std::hypot(query.direction[0], query.direction[1], query.direction[2]);
    if (length == 0 || random.chance(0.3)) query.direction = random.inBall(), length = 1;
    const double speed = random.chance(0.5) ? 1 : power(random, 100);
    for (double& c : query.direction) c = c / length * speed;
    if (random.chance(0.2))
      query.direction[static_cast<size_t>(random.integer(0, 2))] *= random.chance(0.5) ? 0 : 1e-13;
    if (query.direction == std::array<double, 3>{}) query.direction = {0, speed, 0};
    query.distance = random.chance(0.1) ? 0 : random.chance(0.1) ? 1e300 : world * random.uniform(0, 8);
    if (random.chance(0.1)) query.exclude = {0};
    if (random.chance(0.1)) query.mask = 2;
    out.queries.push_back(query);
  }
}

}  // namespace wild
