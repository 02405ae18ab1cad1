#include "proof/known_scene.h"

#include <array>
#include <cmath>

#include "scene/scene.h"

namespace radar {

namespace {

// SplitMix64: the same numbers everywhere.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  uint64_t bits() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(bits() % n); }
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  float near(double x, double off) { return static_cast<float>(x + uniform(-off, off)); }

 private:
  uint64_t state_;
};

struct Shape {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Shape box() {
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) shape.positions.push_back((i >> k & 1) != 0 ? 1.0f : -1.0f);
  }
  shape.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return shape;
}

// Two tips and a ring around them.
Shape jagged(Numbers& numbers) {
  constexpr uint32_t kRing = 7;
  Shape shape{{numbers.near(0, 0.2), numbers.near(0, 0.2), -1.5f, numbers.near(0, 0.2), numbers.near(0, 0.2), 1.5f},
              {}};
  for (uint32_t i = 0; i < kRing; ++i) {
    const double x = std::array{1.0, 0.6, -0.2, -0.9, -0.9, -0.2, 0.6}[i],
                 y = std::array{0.0, 0.8, 1.0, 0.4, -0.4, -1.0, -0.8}[i];
    shape.positions.insert(shape.positions.end(), {numbers.near(x, 0.3), numbers.near(y, 0.3), numbers.near(0, 0.3)});
    const uint32_t p = 2 + i, q = 2 + (i + 1) % kRing;
    for (const uint32_t corner : {0u, q, p, 1u, p, q}) shape.indices.push_back(corner);
  }
  return shape;
}

Shape needles(Numbers& numbers) {
  Shape shape;
  for (uint32_t i = 0; i < 9; ++i) {
    const double along = i % 3 == 0 ? -3 : 3;
    shape.positions.insert(shape.positions.end(),
                           {numbers.near(along, 0.5), numbers.near(0, 0.02), numbers.near(0, 0.02)});
    shape.indices.push_back(i);
  }
  return shape;
}

Shape sheet(Numbers& numbers) {
  constexpr uint32_t kSide = 5;
  Shape shape;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const uint32_t column = i % kSide, row = i / kSide;
    shape.positions.insert(shape.positions.end(),
                           {static_cast<float>(column) - 2, static_cast<float>(row) - 2, numbers.near(0, 0.2)});
    if (column == kSide - 1 || row == kSide - 1) continue;
    for (const uint32_t corner : {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide})
      shape.indices.push_back(corner);
  }
  return shape;
}

// Of floats. The origin of the mesh's vertices goes near `at`.
Transform poseAt(Numbers& numbers, const Vector& at, const Vector& origin, bool isTurned) {
  Transform pose;
  do {
    for (size_t i = 0; i < 12 && isTurned; ++i) pose.m[i] = numbers.near(0, 1);
  } while (std::abs(determinant(pose)) < 0.1);
  for (size_t row = 0; row < 3; ++row) {
    double place = at[row];
    for (size_t k = 0; k < 3; ++k) place -= pose.m[4 * row + k] * origin[k];
    pose.m[4 * row + 3] = static_cast<float>(place);
  }
  return pose;
}

}  // namespace

KnownScene::KnownScene(uint64_t seed) {
  Numbers numbers(seed);
  constexpr size_t kShapes = 4;
  const Vector origins[kShapes] = {{0, 0, 0}, {300.7, -50.1, 7.3}, {-1, 2, 20.5}, {-90.25, 0, 11}};
  const Shape shapes[kShapes] = {box(), jagged(numbers), needles(numbers), sheet(numbers)};
  for (size_t i = 0; i < kShapes; ++i) {
    std::vector<float> positions = shapes[i].positions;
    for (size_t k = 0; k < positions.size(); ++k) positions[k] += static_cast<float>(origins[i][k % 3]);
    meshes.push_back(scene.addMesh(positions, shapes[i].indices));
  }
  const Vector centre = seed % 2 == 0 ? Vector{} : Vector{65536.12345678895, -8192.3, 301.7};
  std::vector<Vector> places;
  const auto place = [&](double spread, size_t& shape, bool& isTurned) {
    shape = numbers.below(kShapes);
    isTurned = shape != 0 || numbers.below(2) == 0;
    Vector at = centre;
    for (double& x : at)
      x += isTurned ? numbers.uniform(-spread, spread) : std::floor(numbers.uniform(-spread, spread));
    return at;
  };
  size_t shape = 0;
  bool isTurned = false;
  for (uint32_t i = 0; i < 32; ++i) {
    places.push_back(place(8, shape, isTurned));
    scene.addObject({.mesh = meshes[shape],
                     .worldFromMesh = poseAt(numbers, places.back(), origins[shape], isTurned),
                     .mask = numbers.below(8) == 0 ? 2u : 3u});
  }
  for (uint32_t i = 0; i < 24; ++i) {
    const Vector at = place(10, shape, isTurned), &to = places[numbers.below(32)];
    Query query{.mesh = meshes[shape], .worldFromMesh = poseAt(numbers, at, origins[shape], isTurned)};
    for (size_t k = 0; k < 3; ++k) query.direction[k] = static_cast<float>(to[k] - at[k]);
    if (i % 4 == 0 || query.direction == Vector{}) query.direction = {0, i % 8 == 0 ? 1.0 : 0.0, -1};
    query.distance = static_cast<float>(numbers.uniform(2, 20));
    query.anyHit = i % 8 == 3;
    query.ignoreLeaving = i % 4 == 2;
    if (i % 8 == 2) query.slack = 0x1p-20;
    query.mask = i % 5 == 0 ? 1 : ~0u;
    if (i % 3 == 0) query.exclude = {numbers.below(32)};
    queries.push_back(query);
  }
}

}  // namespace radar
