#include "workloads/turning_families.h"

#include <numbers>

#include "workloads/random_shapes.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// About y, by the angle with this tangent.
Rotation tiltAboutY(double tangent) {
  const double c = 1 / std::sqrt(1 + tangent * tangent), s = c * tangent;
  return {c, 0, s, 0, 1, 0, -s, 0, c};
}

/// About x, by a random whole number of degrees.
Rotation rollAboutX(Random& random) {
  const auto [c, s] = circlePoint(random.below(360), 360);
  return {1, 0, 0, 0, c, -s, 0, s, c};
}

HardCase turning(PlacedMesh sensor, PlacedMesh object, const Turn& turn, const Vec3& motion = {}) {
  HardCase hard{.sensor = std::move(sensor), .objects = {std::move(object)}, .direction = motion, .distance = 1};
  hard.turn = turn;
  return hard;
}

/// Shapes of a kind, the second one somewhere around the first.
HardCase pairAround(MeshData (*make)(Random&), const Turn& turn, const Vec3& motion, Random& random) {
  MeshData sensor = make(random), object = make(random);
  const Rotation first = random.rotation(), second = random.rotation();
  const double away = random.uniform(0.5, 4);
  const Vec3 where = away * random.direction();
  return turning({std::move(sensor), makePose(first, kFull, {})}, {std::move(object), makePose(second, kFull, where)},
                 turn, motion);
}

/// Bars along x go around x; the edges meet in parallel, but for the tilt.
HardCase edgesCase(double angle, Random& random) {
  const Rotation own = rollAboutX(random), other = product(tiltAboutY(angle), rollAboutX(random));
  const auto [c, s] = circlePoint(40 + random.below(280), 360);
  const double along = random.uniform(-1.9, 1.9), out = random.uniform(2.6, 3.4), by = random.oneIn(2) ? 6 : -6;
  return turning({makeBox({2, 0.5, 0.5}), makePose(own, kFull, {0, 3, 0})},
                 {makeBox({2, 0.5, 0.5}), makePose(other, kFull, {along, out * c, out * s})}, {{1, 0, 0}, by, {}});
}

/// The corners of a bar, hypot(2, 0.5) from the axis, pass a wall.
HardCase grazingCase(double depth, Random& random) {
  const double wall = std::sqrt(4.25) - depth, from = random.uniform(0.2, 1), by = random.oneIn(2) ? 6 : -6;
  return turning({makeBox({4, 1, 1}), makePose(product(Rotation{0, -1, 0, 1, 0, 0, 0, 0, 1}, kUpright), kFull, {})},
                 {makeBox({1, 6, 2}), placedAt({wall + 0.5, 0, from})}, {{0, 0, 1}, by, {0, 0, random.uniform(-9, 9)}});
}

HardCase farCase(double distance, Random& random) {
  const Vec3 axis = random.direction(), centre = distance * random.direction();
  const double way = random.uniform(-6, 6);
  return pairAround(convexShape, {axis, way / distance, centre}, {}, random);
}

HardCase manyCase(double angle, Random& random) {
  const Vec3 axis = random.oneIn(3) ? random.axis() : random.direction(), centre = random.inCube(1);
  const double rise = random.uniform(-5, 5);
  return pairAround(convexShape, {axis, angle, centre}, rise * axis, random);
}

/// A box about one of its edges, onto a plate as near as the turn leads.
HardCase tinyCase(double angle, Random& random) {
  const double gap = angle * random.uniform(0.2, 2.5);
  return turning({makeBox({2, 2, 2}), placedAt({0, 0, 1 + gap})}, {makeBox({40, 40, 1}), placedAt({0, 0, -0.5})},
                 {{0, 1, 0}, angle, {-1, 0, gap}});
}

HardCase interlockedCase(double which, Random& random) {
  Interlocked pair = interlockedShapes()[static_cast<size_t>(which)];
  const Vec3 axis = random.oneIn(2) ? random.axis() : random.direction(), centre = random.inCube(0.5);
  const double angle = random.uniform(-2, 2) * random.magnitude(-2, 0);
  const Vec3 motion = random.oneIn(2) ? Vec3{} : random.inCube(0.5);
  return turning({std::move(pair.first), {}}, {std::move(pair.second), makePose(pair.rotation, kFull, pair.offset)},
                 {axis, angle, centre}, motion);
}

HardCase screwCase(double rise, Random& random) {
  const Vec3 axis = random.direction(), centre = random.inCube(1);
  const double angle = random.uniform(-6, 6);
  return pairAround(nonConvexShape, {axis, angle, centre}, rise * angle * axis, random);
}

/// A box on a plate turns across it, rolls over an edge, or about a corner.
HardCase restingCase(double gap, Random& random) {
  const Vec3 axes[] = {{0, 0, 1}, {0, 1, 0}, {1, 1, 0}, random.direction()};
  const Vec3 axis = axes[random.below(4)];
  const double angle = random.uniform(-3, 3);
  const Vec3 corner{random.oneIn(2) ? 1.0 : -1.0, 1, gap};
  return turning({makeBox({2, 2, 2}), placedAt({0, 0, 1 + gap})}, {makeBox({40, 40, 1}), placedAt({0, 0, -0.5})},
                 {axis, angle, corner});
}

HardCase latticeTurn(double, Random& random) {
  MeshData sensor = latticeShape(random), object = latticeShape(random);
  const Rotation first = random.quarterTurns(), second = random.quarterTurns();
  const Vec3 where = random.wholeVector(3), axis = random.axis(), centre = random.wholeVector(3);
  const double angle = kQuarter * (1 + random.below(4));
  const Vec3 motion = random.oneIn(2) ? Vec3{} : random.wholeVector(2);
  return turning({std::move(sensor), makePose(first, kFull, {})}, {std::move(object), makePose(second, kFull, where)},
                 {axis, angle, centre}, motion);
}

HardCase thinTurn(double which, Random& random) {
  const auto soup = [&] { return makeSoup(which == 0 ? Soup::needles : Soup::degenerate, 40, random); };
  MeshData sensor = soup(), object = soup();
  const Vec3 axis = random.direction(), centre = random.inCube(2), where = random.inCube(1), motion = random.inCube(1);
  const double angle = random.uniform(-3, 3);
  return turning({std::move(sensor), {}}, {std::move(object), placedAt(where)}, {axis, angle, centre}, motion);
}

}  // namespace

const std::vector<HardFamily>& turningFamilies() {
  static const std::vector<HardFamily> families{
      {"turning edges", "angle between edges that meet, radians", {0, 1e-12, 1e-9, 1e-6, 1e-3, 0.3}, edgesCase},
      {"turning by", "how deep corners pass a wall", {1e-2, 1e-5, 1e-8, 1e-12, 0, -1e-12, -1e-8, -1e-5}, grazingCase},
      {"far centre", "distance of the centre", {1e1, 1e2, 1e4, 1e6, 1e8}, farCase},
      {"many turns", "angle", {7, 50, 400, 3000}, manyCase},
      {"tiny turn", "angle", {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}, tinyCase},
      {"interlocked turn", "as of interlocking", {0, 1, 2, 3, 4, 6}, interlockedCase},
      {"screw", "rise for each radian", {0, 0.01, 0.1, 1, 10}, screwCase},
      {"resting turn", "gap between a box and the plate below it", {0, 1e-13, 1e-10, 1e-7, 1e-4}, restingCase},
      {"lattice turn", "", {0}, latticeTurn},
      {"thin turn", "0 needles, 1 degenerate", {0, 1}, thinTurn}};
  return families;
}

}  // namespace radar::tools
