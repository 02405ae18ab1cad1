// Normals at ties that are known.
#include "normal_scenes.h"

using namespace radar;
using test::add;
using test::at;
using tools::MeshData;

TEST_CASE("at a tie the normal is that of the surfaces, not of the pair with the least name") {
  const auto normalOf = [](const MeshData& mesh, const Transform& pose, const MeshData& other,
                           const std::array<double, 3>& direction) {
    Scene scene;
    scene.addObject({add(scene, other), Transform{}});
    const Query query{.mesh = add(scene, mesh), .worldFromMesh = pose, .direction = direction, .distance = 30};
    const Result result = test::answer(scene, query);
    REQUIRE(result.status == Status::hit);
    CHECK(oracle::faultOfNormal(scene, query, result).empty());
    return result.normal;
  };
  using Normal = std::array<double, 3>;
  // A corner of a box passes a corner of the other's face.
  CHECK(normalOf(normals::latticeBox(3, 3, 1), at(2, -6, 1), normals::latticeBox(3, 3, 3), {-1, 3, -1}) ==
        Normal{0, -1, 0});
  // Two boxes on one floor, head-on: their undersides, in one plane with the motion, have no normal.
  CHECK(normalOf(normals::latticeBox(2, 2, 2), at(-5, 0, 0), normals::latticeBox(2, 2, 2), {1, 0, 0}) ==
        Normal{-1, 0, 0});
  // The first event is a corner on the border of a face, behind which the other triangle lies.
  const MeshData a{"", {2, 2, -2, 2, 2, -3, 4, 2, 1}, {0, 1, 2}}, b{"", {3, 4, -3, 4, 4, -4, 4, 3, -3}, {0, 1, 2}};
  const Normal n = normalOf(a, Transform{}, b, {3, 3, 0});
  CHECK(n[0] + n[1] < 0);
  // A point before a segment in line with it, and before a point.
  const MeshData point{"", {0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 2}}, segment{"", {4, 0, 0, 8, 0, 0, 6, 0, 0}, {0, 1, 2}};
  CHECK(normalOf(point, Transform{}, segment, {2, 0, 0}) == Normal{-1, 0, 0});
  CHECK(normalOf(point, at(0, -3, 0), point, {0, 1, 0}) == Normal{0, -1, 0});
}
