// Scenes at the limits of the range of doubles: sizes from 10^-150 to 10^150, far origins, nearly singular poses,
// motions of every length.
#pragma once

#include "soups.h"

namespace wild {

using radar::tools::makePose;
using radar::tools::Rotation;
using radar::tools::Vec3;
using radar::tools::operator+;
using radar::tools::operator-;
using radar::tools::operator*;
using soups::Random;

/// 10 to a random power between -most and most.
inline double power(Random& random, double most) {
  return std::pow(10.0, random.uniform(-most, most));
}

/// A soup, a lattice or a box with coordinates times `scale`, within the range of floats; sometimes far from its
/// origin, flat, a segment or a point.
inline radar::tools::MeshData mesh(Random& random, double scale) {
  const int kind = random.integer(0, 5);
  radar::tools::MeshData out = kind == 0   ? radar::tools::makeBox(random.inBox({0.2, 0.2, 0.2}, {2, 2, 2}))
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

/// A rotation, often scaled differently along its axes, sheared, mirrored, or flattened until it is hardly invertible.
inline radar::Transform pose(Random& random, double scale, const Vec3& at) {
  for (;;) {
    Vec3 stretch{1, 1, 1};
    if (random.chance(0.4)) {
      for (double& s : stretch) s = random.uniform(0.2, 2) * (random.chance(0.2) ? -1 : 1);
    }
    if (random.chance(0.2)) stretch[random.below(3)] *= power(random, 11.5);
    const double shear = random.chance(0.2) ? power(random, 5) : 0;
    const Rotation turned =
        radar::tools::product(radar::tools::linearPart(makePose(random.rotation(), stretch, {})), random.rotation());
    radar::Transform out = makePose(turned, {scale, scale, scale}, at);
    for (size_t i = 0; i < 3; ++i) out.m[4 * i + 1] += shear * out.m[4 * i];
    if (random.chance(0.2)) out = makePose(radar::tools::kUpright, scale * stretch, at);
    if (radar::validate(out).empty()) return out;
  }
}

using Made = radar::test::Case;

/// Sizes range from 10^-most to 10^most.
inline void make(Random& random, double most, Made& out) {
  const double world = power(random, most);
  // A pose scales a mesh of size 10^-30 to 10^30 to about the size of the world, or to a much smaller or larger one.
  const auto size = [&] { return random.chance(0.7) ? random.uniform(0.3, 2) : power(random, 4); };
  std::vector<radar::MeshId> meshes;
  std::vector<double> units;
  for (int m = 0; m < 3; ++m) {
    units.push_back(random.chance(0.5) ? 1 : power(random, 30));
    meshes.push_back(radar::test::add(out.scene, mesh(random, units.back())));
  }
  Vec3 centre{};
  if (random.chance(0.4)) {
    const double far = random.chance(0.5) ? power(random, 3) : power(random, 10);
    centre = random.inCube(world * far);
  }
  const auto placed = [&](size_t m, double spread) {
    const Vec3 near = centre + world * spread * random.inBall();
    return pose(random, world * size() / units[m], near);
  };
  for (int i = random.integer(1, 6); i-- > 0;) {
    const size_t m = random.below(3);
    out.scene.addObject({meshes[m], placed(m, 3), random.chance(0.2) ? 1u : ~0u});
  }
  for (int q = 0; q < 8; ++q) {
    radar::Query query;
    const size_t m = random.below(3);
    query.mesh = meshes[m];
    query.worldFromMesh = placed(m, random.chance(0.3) ? 0.5 : 4);
    // Most directions point towards an object.
    Vec3 ahead = radar::test::placeOf(out.scene.object(0).worldFromMesh) - radar::test::placeOf(query.worldFromMesh);
    double length = std::hypot(ahead[0], ahead[1], ahead[2]);
    if (length == 0 || random.chance(0.3)) ahead = random.inBall(), length = 1;
    const double speed = random.chance(0.5) ? 1 : power(random, 100);
    for (size_t k = 0; k < 3; ++k) query.direction[k] = ahead[k] / length * speed;
    if (random.chance(0.2)) query.direction[random.below(3)] *= random.chance(0.5) ? 0 : 1e-13;
    if (query.direction == Vec3{}) query.direction = {0, speed, 0};
    query.distance = random.chance(0.1) ? 0 : random.chance(0.1) ? 1e300 : world * random.uniform(0, 8);
    if (random.chance(0.1)) query.exclude = {0};
    if (random.chance(0.1)) query.mask = 2;
    out.queries.push_back(query);
  }
}

}  // namespace wild
