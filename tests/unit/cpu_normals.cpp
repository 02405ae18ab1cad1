// The CPU's normals, judged in exact arithmetic over all pairs of triangles.
#include "normal_scenes.h"

using namespace radar;
using normals::Case;
using normals::Judged;
using soups::Random;

namespace {

template <class Fill>
Judged judged(uint64_t seed, int cases, const Fill& fill) {
  Judged all;
  for (int i = 0; i < cases; ++i) {
    Random random(seed + static_cast<uint64_t>(i));
    Case one;
    fill(random, one);
    const std::vector<Result> results = CpuSweeper(one.scene, 1).run(one.queries).results;
    for (size_t q = 0; q < results.size(); ++q) {
      const size_t before = all.faults.size();
      all.add(one.scene, one.queries[q], results[q]);
      if (all.faults.size() != before) UNSCOPED_INFO("first in case " << i << ", query " << q);
    }
  }
  return all;
}

}  // namespace

TEST_CASE("at a tie the normal is that of the surfaces, not of the pair with the least name") {
  const auto normalOf = [](const soups::Mesh& mesh, const Transform& pose, const soups::Mesh& other,
                           const std::array<double, 3>& direction) {
    Scene scene;
    scene.addObject({soups::add(scene, other), Transform{}});
    const Query query{.mesh = soups::add(scene, mesh), .worldFromMesh = pose, .direction = direction, .distance = 30};
    const Result result = test::answer(scene, query);
    REQUIRE(result.status == Status::hit);
    CHECK(oracle::faultOfNormal(scene, query, result).empty());
    return result.normal;
  };
  using Normal = std::array<double, 3>;
  // A corner of a box passes a corner of the other's face.
  CHECK(normalOf(normals::latticeBox(3, 3, 1), soups::at(2, -6, 1), normals::latticeBox(3, 3, 3), {-1, 3, -1}) ==
        Normal{0, -1, 0});
  // Two boxes on one floor, head-on: their undersides, in one plane with the motion, have no normal.
  CHECK(normalOf(normals::latticeBox(2, 2, 2), soups::at(-5, 0, 0), normals::latticeBox(2, 2, 2), {1, 0, 0}) ==
        Normal{-1, 0, 0});
  // The first event is a corner on the border of a face, behind which the other triangle lies.
  const soups::Mesh a{{2, 2, -2, 2, 2, -3, 4, 2, 1}, {0, 1, 2}}, b{{3, 4, -3, 4, 4, -4, 4, 3, -3}, {0, 1, 2}};
  const Normal n = normalOf(a, Transform{}, b, {3, 3, 0});
  CHECK(n[0] + n[1] < 0);
  // A point before a segment in line with it, and before a point.
  const soups::Mesh point{{0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 2}}, segment{{4, 0, 0, 8, 0, 0, 6, 0, 0}, {0, 1, 2}};
  CHECK(normalOf(point, Transform{}, segment, {2, 0, 0}) == Normal{-1, 0, 0});
  CHECK(normalOf(point, soups::at(0, -3, 0), point, {0, 1, 0}) == Normal{0, -1, 0});
}

TEST_CASE("boxes on a lattice have normals that keep their surfaces apart") {
  const Judged all = judged(0, 400, [](Random& random, Case& out) { normals::boxes(random, false, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 300);
}

TEST_CASE("boxes on one floor have normals that keep their surfaces apart") {
  const Judged all = judged(0, 300, [](Random& random, Case& out) { normals::boxes(random, true, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 300);
}

TEST_CASE("lattice triangles have normals that keep their surfaces apart, where any normal does") {
  const Judged all = judged(0, 1500, [](Random& random, Case& out) { normals::lattices(random, false, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 1000);
}

TEST_CASE("triangles in one plane have normals across their sides") {
  const Judged all = judged(0, 400, [](Random& random, Case& out) { normals::lattices(random, true, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 300);
}

TEST_CASE("soups of floats and needles have normals that keep their surfaces apart") {
  for (const double stretch : {1.0, 1e-4, 1e4, 1e8}) {
    CAPTURE(stretch);
    const Judged all = judged(0, 100, [&](Random& random, Case& out) { normals::floats(random, stretch, out); });
    INFO(all.words());
    CHECK(all.faults.empty());
    CHECK(all.hits > 20);
  }
}

TEST_CASE("where corners and borders meet exactly, normals keep the surfaces apart, where any normal does") {
  const Judged all = judged(0, 2000, [](Random& random, Case& out) { normals::meetings(random, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 1000);
}
