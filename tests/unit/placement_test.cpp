// Checks placements with exact arithmetic: the floats by which the device's search knows a placed mesh, and their
// errors.
#include <cmath>

#include "support/catch.h"
#include "support/exact_placement.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::BoundsUsed;
using test::checkPlacement;
using tools::Random;

// A few triangles around `middle`, up to `size` from it.
MeshId addSoup(Scene& scene, Random& random, double size, const std::array<double, 3>& middle) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 12; ++i) {
    indices.push_back(i);
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(middle[k] + random.uniform(-size, size)));
  }
  return scene.addMesh(positions, indices);
}

double powerOfTwo(Random& random, int lowest, int highest) {
  return std::ldexp(random.uniform(1, 2), lowest + int(random.below(uint32_t(highest - lowest + 1))));
}

// Rotated, scaled unevenly and sheared; sometimes nearly flat.
Transform randomPose(Random& random, double scale, double away) {
  Transform pose = random.affine(random.inCube(away));
  const bool flat = random.oneIn(4);
  const double flattened = flat ? powerOfTwo(random, -20, -1) : 1;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) pose.m[4 * row + k] *= scale * (k == 2 ? flattened : 1);
  }
  return pose;
}

}  // namespace

TEST_CASE("a placement's floats place every vertex within the error that it states") {
  Random random(41);
  BoundsUsed used;
  size_t inRange = 0;
  for (int i = 0; i < 4000; ++i) {
    Scene scene;
    const double size = powerOfTwo(random, -30, 30);
    const double baked = random.oneIn(2) ? 0 : size * powerOfTwo(random, -4, 20);
    const std::array<double, 3> middle = random.inBox({-baked, -baked, -baked}, {baked, baked, baked});
    const Mesh& mesh = scene.impl().meshes[addSoup(scene, random, size, middle)];
    const double scale = powerOfTwo(random, -40, 40), away = random.oneIn(3) ? 0 : powerOfTwo(random, -60, 60);
    const Transform pose = randomPose(random, scale, away);
    const gpu::Placement placement = placementOf(mesh, pose);
    if (!isInRange(placement)) continue;
    ++inRange;
    CAPTURE(i, size, baked, scale, away);
    checkPlacement(mesh, pose, placement, used);
  }
  CHECK(inRange > 3500);
  // Neither bound is far too large.
  CHECK(used.error > 0.01);
  CHECK(used.inverse > 0.1);
}

TEST_CASE("vertices far from the origin that the pose brings back are placed within the stated error") {
  // The pose takes back the offset of the vertices, so nearly all digits cancel.
  Random random(43);
  BoundsUsed used;
  for (int i = 0; i < 500; ++i) {
    Scene scene;
    const double baked = powerOfTwo(random, 0, 20);
    const std::array<double, 3> middle = random.inBox({-baked, -baked, -baked}, {baked, baked, baked});
    const Mesh& mesh = scene.impl().meshes[addSoup(scene, random, 1, middle)];
    Transform pose = randomPose(random, 1, 0);
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) pose.m[4 * row + 3] -= pose.m[4 * row + k] * middle[k];
    }
    const gpu::Placement placement = placementOf(mesh, pose);
    REQUIRE(isInRange(placement));
    CAPTURE(i, baked);
    checkPlacement(mesh, pose, placement, used);
    CHECK(placement.error < 1e-9 * (1 + baked));
  }
}

TEST_CASE("products of the coarse part with anchors of 8 bits are exact, and the fine part adds the rest") {
  Random random(47);
  for (int i = 0; i < 2000; ++i) {
    Scene scene;
    const Mesh& mesh = scene.impl().meshes[addSoup(scene, random, powerOfTwo(random, -20, 20), {})];
    const Transform pose = randomPose(random, powerOfTwo(random, -20, 20), 10);
    const gpu::Placement placement = placementOf(mesh, pose);
    REQUIRE(isInRange(placement));
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) {
        const float coarse = placement.coarse[4 * row + k], fine = placement.fine[4 * row + k];
        const float anchor = std::floor(static_cast<float>(random.uniform(-2, 2)) * 128 + 0.5f) / 128;
        CHECK(double{coarse * anchor} == double{coarse} * anchor);
        const double exact = pose.m[4 * row + k] * mesh.unit;
        CHECK(std::abs(double{coarse} + fine - exact) <= 0x1p-39 * std::abs(exact));
      }
    }
  }
}

TEST_CASE("meshes and poses that floats cannot represent have placements out of range") {
  Scene scene;
  Random random(53);
  const Mesh& mesh = scene.impl().meshes[addSoup(scene, random, 1, {})];
  const auto placed = [&](double scale, double away) {
    return placementOf(mesh, {{scale, 0, 0, away, 0, scale, 0, 0, 0, 0, scale, 0}});
  };
  CHECK(isInRange(placed(1, 0)));
  CHECK(isInRange(placed(0x1p70, 0)));
  CHECK(isInRange(placed(0x1p-70, 0)));
  CHECK(isInRange(placed(1, 0x1p79)));
  for (const auto& [scale, away] :
       {std::pair{0x1p90, 0.0}, {0x1p-90, 0.0}, {1.0, 0x1p81}, {1.0, -1e300}, {1e300, 0.0}, {1e-300, 0.0}}) {
    CAPTURE(scale, away);
    const gpu::Placement placement = placed(scale, away);
    CHECK_FALSE(isInRange(placement));
    CHECK(placement.error == 0);
  }
  // One column is too small beside the others.
  CHECK_FALSE(isInRange(placementOf(mesh, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e-80, 0}})));
  // A mesh whose own coordinates are too large, although the pose scales them back.
  const Mesh& huge = scene.impl().meshes[addSoup(scene, random, 0x1p100, {})];
  CHECK_FALSE(isInRange(placementOf(huge, {{0x1p-100, 0, 0, 0, 0, 0x1p-100, 0, 0, 0, 0, 0x1p-100, 0}})));
}
