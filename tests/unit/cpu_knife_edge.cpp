// Configurations one ulp away from touching, and changes of a scene that must not change an answer.
#include <bit>

#include "soups.h"
#include "support/answer.h"
#include "support/catch.h"

using namespace radar;
using soups::Random;
using test::add;
using test::at;
using tools::placedAt;
using tools::operator+;
using tools::operator-;

namespace {

using Vector = tools::Vec3;

Result sweepPair(const tools::MeshData& a, const Transform& poseA, const tools::MeshData& b, const Transform& poseB,
                 const Vector& direction, double distance) {
  Scene scene;
  const MeshId sensor = add(scene, a);
  scene.addObject({add(scene, b), poseB});
  return test::answer(scene, {.mesh = sensor, .worldFromMesh = poseA, .direction = direction, .distance = distance});
}

void requireSameTimes(const Result& p, const Result& q) {
  REQUIRE(p.status == q.status);
  for (const auto& [x, y] : {std::pair{p.t, q.t}, {p.lo, q.lo}, {p.hi, q.hi}, {p.fraction, q.fraction}}) {
    REQUIRE(std::bit_cast<uint64_t>(x) == std::bit_cast<uint64_t>(y));
  }
}

/// Calls body(sign, order) for the eight octants and the six orders of the axes.
template <class Body>
void forEachSymmetry(const Body& body) {
  for (int octant = 0; octant < 8; ++octant) {
    std::array<int, 3> order{0, 1, 2};
    do {
      body(Vector{octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0}, order);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

Vector mapped(const Vector& v, const Vector& sign, const std::array<int, 3>& order) {
  Vector out;
  for (size_t k = 0; k < 3; ++k) out[static_cast<size_t>(order[k])] = v[k] * sign[k];
  return out;
}

}  // namespace

TEST_CASE("boxes that slide past each other touch at gap zero and do not touch one ulp apart") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  forEachSymmetry([&](const Vector& sign, const std::array<int, 3>& order) {
    const Vector ahead = mapped({0, 0, 1}, sign, order);
    for (double side : {1.0, std::nextafter(1.0, 2.0), std::nextafter(1.0, 0.0)}) {
      // The boxes are apart, by one ulp, exactly if `side` exceeds 1.
      const Result result = sweepPair(box, Transform{}, box, placedAt(mapped({side, 0.25, 4}, sign, order)), ahead, 10);
      REQUIRE(result.status == (side > 1 ? Status::clear : Status::hit));
      if (side <= 1) REQUIRE(result.t == 3);
    }
  });
}

TEST_CASE("edges and vertices that graze touch at gap zero and do not touch one ulp apart") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const Vector direction{1, 2, 4};
  // Box b at w touches while w_k - 1 <= s d_k <= w_k + 1 for each k. At s = 3 contact begins in x and ends in y: edge
  // on edge. If it also begins (z = 13) or ends (z = 11) in z: vertex on vertex.
  for (double z : {12.0, 13.0, 11.0}) {
    const Vector graze{4, 5, z};
    forEachSymmetry([&](const Vector& sign, const std::array<int, 3>& order) {
      const Vector d = mapped(direction, sign, order);
      const Result touch = sweepPair(box, Transform{}, box, placedAt(mapped(graze, sign, order)), d, 100);
      REQUIRE(touch.status == Status::hit);
      REQUIRE(touch.lo <= 3 * std::sqrt(21.0));
      REQUIRE(touch.hi >= 3 * std::sqrt(21.0));
      for (int k = 0; k < 3; ++k) {
        for (double way : {-100.0, 100.0}) {
          Vector w = graze;
          w[static_cast<size_t>(k)] = std::nextafter(w[static_cast<size_t>(k)], way);
          // Apart if contact begins later in x (or z = 13), or ends earlier in y (or z = 11).
          const bool apart = (k == 0 && way > 0) || (k == 1 && way < 0) || (k == 2 && z == 13 && way > 0) ||
                             (k == 2 && z == 11 && way < 0);
          const Result result = sweepPair(box, Transform{}, box, placedAt(mapped(w, sign, order)), d, 100);
          REQUIRE(result.status == (apart ? Status::clear : Status::hit));
        }
      }
    });
  }
}

TEST_CASE("contact at exactly D counts, and one ulp before contact is clear, if |direction| is rational") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  for (const auto& [direction, length] :
       {std::pair{Vector{2, 3, 6}, 7.0}, {Vector{1, 4, 8}, 9.0}, {Vector{0, 3, -4}, 5.0}}) {
    // Contact begins at s = 3 in the largest component and earlier in the others.
    Vector w;
    for (size_t k = 0; k < 3; ++k) w[k] = 3 * direction[k];
    const size_t largest = 2;
    w[largest] += direction[largest] > 0 ? 1 : -1;
    const double t = 3 * length;
    const Result touch = sweepPair(box, Transform{}, box, placedAt(w), direction, t);
    REQUIRE(touch.status == Status::hit);
    REQUIRE(touch.t == t);
    REQUIRE(touch.hi == t);
    REQUIRE(sweepPair(box, Transform{}, box, placedAt(w), direction, std::nextafter(t, 0)).status == Status::clear);
  }
}

namespace {

/// Triangles in another order, and their vertices.
tools::MeshData shuffled(Random& random, tools::MeshData mesh) {
  for (uint32_t t = mesh.triangleCount(); t-- > 0;) {
    const auto first = mesh.indices.begin() + 3 * t, other = mesh.indices.begin() + 3 * random.below(t + 1);
    if (first != other) std::swap_ranges(first, first + 3, other);
    std::rotate(first, first + random.integer(0, 2), first + 3);
    if (random.chance(0.5)) std::swap(first[0], first[1]);
  }
  return mesh;
}

}  // namespace

TEST_CASE("neither swapping the two, nor another order of triangles, nor an exact shift changes a bit of t") {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    INFO("seed " << seed);
    const bool grid = seed % 2 == 0;
    const auto mesh = [&] { return grid ? soups::lattice(random, 8, 3) : soups::soup(random, 8, 0.6, 0.3); };
    const auto pose = [&](double z) {
      return grid ? at(random.integer(-1, 1), random.integer(-1, 1), z) : random.pose(1, {0.1, 0.2, 0.6 * z});
    };
    tools::MeshData a = mesh(), b = mesh();
    const Transform poseA = pose(0), poseB = pose(random.integer(0, 6));
    const Vector d{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 1};
    const Vector direction = grid ? Vector{std::round(5 * d[0]), std::round(5 * d[1]), 2} : d;
    const Result result = sweepPair(a, poseA, b, poseB, direction, 20);
    requireSameTimes(result, sweepPair(b, poseB, a, poseA, Vector{} - direction, 20));
    requireSameTimes(result, sweepPair(shuffled(random, a), poseA, shuffled(random, b), poseB, direction, 20));
    // Multiples of 2^-10 below 8, which shifts up to 2^39 keep.
    for (tools::MeshData* rounded : {&a, &b}) {
      for (float& c : rounded->positions) c = std::round(c * 1024) / 1024;
    }
    const double size = std::ldexp(1, random.integer(0, 39)), z = random.integer(0, 3);
    const Vector shift{size * random.integer(-1, 1), size * random.integer(-1, 1), size};
    requireSameTimes(sweepPair(a, Transform{}, b, at(0, 0, z), direction, 20),
                     sweepPair(a, placedAt(shift), b, placedAt(shift + Vector{0, 0, z}), direction, 20));
  }
}
