// One function per family makes its cases. The sensor moves along +z unless the function sets another direction. Most
// cases are turned and moved as a whole afterwards. Each random number is drawn in a statement of its own, since the
// compiler chooses the order in which it evaluates arguments.
#include "workloads/hard_cases.h"

#include <utility>

#include "workloads/generate.h"
#include "workloads/random_shapes.h"
#include "workloads/rest_families.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

Vec3 farOrigin(Random& random) {
  const double distance = random.magnitude(1, 7);
  return distance * random.direction();
}

/// A rotation about x, by the angle with this tangent.
Rotation tilt(double tangent) {
  const double c = 1 / std::sqrt(1 + tangent * tangent), s = c * tangent;
  return {1, 0, 0, 0, c, -s, 0, s, c};
}

/// A rotation about z, by a random whole number of degrees.
Rotation roll(Random& random) {
  const auto [c, s] = circlePoint(random.below(360), 360);
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

/// A distance that a contact after about `gap` may lie beyond.
double reachFor(double gap, Random& random) {
  constexpr std::array<double, 4> kParts{0.7, 1.5, 3, 20};
  return gap * kParts[random.below(4)];
}

/// A closed shape about 1 wide, in any pose around `middle`.
PlacedMesh compact(Random& random, const Vec3& middle) {
  const uint32_t which = random.below(4);
  MeshData mesh = which == 0   ? makeBox({1, 0.8, 0.6})
                  : which == 1 ? resized(makeUvSphere(5, 8), 0.5)
                  : which == 2 ? makeTorus(0.4, 0.15, 12, 6)
                               : makeHook(1, 0.5, 0.4, 0.15);
  const Rotation rotation = random.oneIn(3) ? kUpright : random.rotation();
  return {std::move(mesh), makePose(rotation, kFull, middle)};
}

/// A rotation, sometimes with scale, shear and a mirror.
Transform anyPose(Random& random, const Vec3& where) {
  return random.oneIn(4) ? random.affine(where) : makePose(random.rotation(), kFull, where);
}

using MakeShape = MeshData (*)(Random&);

/// Puts the object above the sensor, mostly in its way.
HardCase pairOf(MakeShape sensor, MakeShape object, Random& random) {
  HardCase hard;
  hard.sensor.mesh = sensor(random);
  hard.sensor.worldFromMesh = anyPose(random, {});
  MeshData mesh = object(random);
  const Vec3 where = random.inBox({-1.2, -1.2, 0.5}, {1.2, 1.2, 5});
  hard.objects.push_back({std::move(mesh), anyPose(random, where)});
  hard.distance = random.oneIn(10) ? 0 : reachFor(where[2], random);
  return hard;
}

HardCase anyPair(Random& random) {
  return pairOf(anyShape, anyShape, random);
}

/// Blocks that touch sideways along as many of x and y as `grazing` says, `gap` apart along z; D is three more.
HardCase blocks(uint32_t grazing, double gap, Random& random) {
  const Block a = block(random), b = block(random);
  Vec3 where{0, 0, a.reach[2] + b.reach[2] + gap};
  const uint32_t first = random.below(2);
  for (uint32_t k = 0; k < 2; ++k) {
    const bool touches = grazing > (k == first ? 0u : 1u);
    where[k] = touches ? a.reach[k] + b.reach[k] : 0.25 * random.below(3);
    if (random.oneIn(2)) where[k] = -where[k];
  }
  return {{a.mesh, {}}, {{b.mesh, placedAt(where)}}, {0, 0, 1}, std::max(gap, 0.0) + 3};
}

double stepped(double value, int ulps) {
  for (; ulps > 0; --ulps) value = std::nextafter(value, INFINITY);
  for (; ulps < 0; ++ulps) value = std::nextafter(value, -INFINITY);
  return value;
}

HardCase thinCase(double pixels, Random& random) {
  const double width = pixels * 2 / 64, gap = random.uniform(0.2, 4);
  HardCase hard{{makePlate(2, 2, 0.5), {}}, {}, {0, 0, 1}, 0};
  MeshData rod = makeRod(0.5 * width, 1, 6);
  if (random.oneIn(2)) {
    rod.positions = {static_cast<float>(-0.5 * width), 0, -0.5, static_cast<float>(0.5 * width), 0, -0.5, 0, 0, 0.5};
    rod.indices = {0, 1, 2};
  }
  const auto rotation = random.oneIn(3) ? kUpright : random.oneIn(2) ? kOnEdge : random.rotation();
  const Vec3 where = random.inBox({-0.9, -0.9, 0.75 + gap}, {0.9, 0.9, 0.75 + gap});
  hard.objects.push_back({std::move(rod), makePose(rotation, kFull, where)});
  hard.distance = reachFor(gap, random);
  return hard;
}

HardCase edgeOnCase(double angle, Random& random) {
  const double gap = random.uniform(0.2, 3);
  const auto upright = [&] { return product(product(tilt(angle), kOnEdge), roll(random)); };
  HardCase hard;
  const MeshData sheet = makeSheet(1 + random.below(3), 0, random);
  const Rotation frame = upright();
  const double x = random.uniform(-0.4, 0.4), y = random.uniform(-0.4, 0.4);
  hard.objects.push_back({sheet, makePose(frame, kFull, {x, y, 1.5 + gap})});
  hard.sensor = compact(random, {});
  if (random.oneIn(2)) {  // another plate edge-on: in the same plane, or across
    const Rotation turnedFrame = upright();
    const Rotation quarter{0, -1, 0, 1, 0, 0, 0, 0, 1};
    const bool across = random.oneIn(2);
    hard.sensor = {sheet, makePose(across ? product(quarter, turnedFrame) : turnedFrame, kFull, {x, y, 0})};
  }
  hard.distance = reachFor(gap + 1, random);
  return hard;
}

HardCase slopeCase(double slope, Random& random) {
  HardCase hard;
  hard.sensor = compact(random, {});
  const Rotation frame = product(roll(random), tilt(slope));
  const double gap = random.uniform(3, 6);
  const Vec3 where = random.inBox({-0.3, -0.3, gap}, {0.3, 0.3, gap});
  hard.objects.push_back({makeSheet(1 + random.below(4), 0, random), makePose(frame, {2, 2, 2}, where)});
  hard.distance = reachFor(gap, random);
  return hard;
}

HardCase touchingCase(double when, Random& random) {
  const double gap = when == 0 ? 0 : 0.5 * (1 + random.below(4));
  HardCase hard = blocks(random.below(3), gap, random);
  if (when == 0 && random.oneIn(3)) {  // side by side from the start: faces in one plane along the motion
    hard = blocks(1 + random.below(2), -0.5, random);
  }
  if (when == 2) hard.distance = gap;
  if (when == 0 && random.oneIn(3)) hard.distance = 0;
  return hard;
}

HardCase ulpCase(double ulps, Random& random) {
  const double gap = 0.5 * random.below(4);
  HardCase hard = blocks(random.below(3), gap, random);
  const bool atEnd = random.oneIn(3);
  if (atEnd) hard.distance = gap;
  const Rotation frame = random.oneIn(3) ? random.rotation() : random.quarterTurns();
  place(hard, frame, 0.5 * random.wholeVector(16));
  if (atEnd && gap > 0 && random.oneIn(2)) {
    hard.distance = stepped(hard.distance, static_cast<int>(-ulps));
  } else {
    double& moved = hard.objects[0].worldFromMesh.m[4 * random.below(3) + 3];
    moved = stepped(moved, static_cast<int>(moved < 0 ? -ulps : ulps));
  }
  return hard;
}

HardCase nearCase(double gap, Random& random) {
  const double along = 0.5 * random.below(4);
  const uint32_t grazing = random.below(3);
  HardCase hard = blocks(grazing, along, random);
  const double side = random.oneIn(2) ? gap : -gap;
  double* where = hard.objects[0].worldFromMesh.m.data();
  if (grazing == 0) {
    hard.distance = along;
    where[11] += side;
  } else {
    for (size_t k : {3, 7}) where[k] += where[k] < 0 ? -side : side;
  }
  return hard;
}

HardCase depthCase(double depth, Random& random) {
  HardCase hard = blocks(random.below(2), -depth, random);
  const double sideways = random.uniform(0, 1.5 * depth);
  double& x = hard.objects[0].worldFromMesh.m[3];
  x -= x < 0 ? -sideways : sideways;
  if (random.oneIn(3)) hard.direction = random.direction();
  if (random.oneIn(4)) hard.distance = 0;
  return hard;
}

/// All coordinates and the direction are multiples of 1/2, so that several contacts come at the same t or exactly at D.
HardCase latticeCase(double how, Random& random) {
  const auto whole = [&] { return placedAt(0.5 * random.wholeVector(6)); };
  HardCase hard;
  hard.sensor.mesh = latticeShape(random);
  for (uint32_t i = 1 + random.below(8); i > 0; --i) {
    MeshData mesh = latticeShape(random);
    hard.objects.push_back({std::move(mesh), whole()});
  }
  hard.direction = random.axis();
  if (random.oneIn(2)) hard.direction = random.wholeVector(2);
  if (hard.direction == Vec3{}) hard.direction = {1, 2, -2};
  hard.distance = random.below(12);
  if (how == 0) {
    const Rotation frame = random.quarterTurns();
    const Vec3 origin = 0.5 * random.wholeVector(12);
    place(hard, frame, origin);
    return hard;
  }
  const Rotation frame = random.rotation();
  place(hard, frame, random.inCube(6));
  if (how == 1) return hard;
  resize(hard, random.magnitude(-3, 3));
  if (random.oneIn(2)) place(hard, kUpright, farOrigin(random));
  if (how == 2) return hard;
  for (PlacedMesh& object : hard.objects) {
    for (double& value : object.worldFromMesh.m) {
      if (random.oneIn(4)) value = stepped(value, random.oneIn(2) ? 1 : -1);
    }
  }
  return hard;
}

HardCase containmentCase(double ratio, Random& random) {
  HardCase hard;
  const uint32_t outer = random.below(3);
  MeshData shell = outer == 0 ? makeBox({2, 2, 2}) : outer == 1 ? makeUvSphere(6, 10) : makeCup(1, 2, 0.1, 16);
  const double middle = outer == 2 ? 1 : 0, room = 0.5 * (1 - ratio);
  hard.sensor = compact(random, random.inBox({-room, -room, middle - room}, {room, room, middle + room}));
  double* m = hard.sensor.worldFromMesh.m.data();
  for (size_t i = 0; i < 12; ++i) m[i] *= i % 4 == 3 ? 1 : ratio;
  hard.objects.push_back({std::move(shell), {}});
  hard.direction = random.oneIn(2) ? random.axis() : random.direction();
  hard.distance = random.uniform(0.1, 3);
  return hard;
}

HardCase degenerateCase(double kind, Random& random) {
  HardCase hard = anyPair(random);
  const auto shape = static_cast<uint32_t>(kind);
  hard.objects[0].mesh = degenerateShape(shape, random);
  if (random.oneIn(3)) hard.sensor.mesh = degenerateShape(shape, random);
  return hard;
}

HardCase soupCase(double kind, Random& random) {
  const Soup soup = kSoups[static_cast<size_t>(kind)];
  HardCase hard = anyPair(random);
  const auto replace = [&](PlacedMesh& placed) {
    placed.mesh = makeSoup(soup, 1 + random.below(120), random);
    placed.worldFromMesh = normalised(soup, placed.worldFromMesh);
  };
  replace(hard.objects[0]);
  if (random.oneIn(2)) replace(hard.sensor);
  return hard;
}

HardCase farPosedCase(double distance, Random& random) {
  HardCase hard = anyPair(random);
  const Vec3 origin = distance * random.direction();
  place(hard, kUpright, origin);
  return hard;
}

HardCase farBakedCase(double distance, Random& random) {
  HardCase hard = anyPair(random);
  const Vec3 origin = distance * random.direction();
  const bool back = random.oneIn(2);
  for (PlacedMesh* placed : {&hard.sensor, &hard.objects[0]}) {
    moveVertices(*placed, origin);
    moveBy(placed->worldFromMesh, (back ? Vec3{} : origin) - turned(linearPart(placed->worldFromMesh), origin));
  }
  return hard;
}

HardCase scaleCase(double scale, Random& random) {
  HardCase hard = anyPair(random);
  resize(hard, scale);
  return hard;
}

HardCase floorCase(double size, Random& random) {
  HardCase hard;
  const Vec3 above = random.inBox({-9e3, -9e3, -3}, {9e3, 9e3, -size});
  hard.sensor = compact(random, {});
  if (random.oneIn(2)) hard.sensor.mesh = anyShape(random);
  resize(hard, size);
  moveBy(hard.sensor.worldFromMesh, above);
  hard.objects.push_back({makeSheet(1 + random.below(8), 0, random), makePose(kUpright, {1e4, 1e4, 1e4}, {})});
  if (random.oneIn(3)) hard.direction = {1, 0, powerOfTen(-static_cast<int>(random.below(7)))};
  if (random.oneIn(4)) hard.direction = random.direction();
  hard.distance = random.oneIn(2) ? 1e5 : random.uniform(0, 4);
  return hard;
}

HardCase directionCase(double off, Random& random) {
  const double gap = 0.5 * random.below(4);
  HardCase hard = blocks(random.below(3), gap, random);
  const uint32_t other = random.below(6);
  if (other == 0) hard.objects[0].mesh = makePlate(2, 2, 0.01);
  if (other == 1) hard.objects[0].mesh = makeSheet(4, 0.1, random);
  if (other == 2) hard.objects[0].mesh = makeRod(0.2, 2, 8);
  const Vec3 aside = random.direction();
  for (size_t k = 0; k < 3; ++k) hard.direction[k] += random.oneIn(3) ? 0 : off * aside[k];
  hard.direction = random.magnitude(-12, 12) * hard.direction;
  hard.distance += random.uniform(0, 3);
  return hard;
}

HardCase distanceCase(double distance, Random& random) {
  // In a scene as long as the greatest D, floats cannot tell triangles apart, so a few of them suffice.
  HardCase hard = blocks(0, 0.5 * random.below(4), random);
  if (random.oneIn(3)) hard.objects[0].worldFromMesh.m[11] += distance;
  hard.distance = distance;
  return hard;
}

HardCase singleCase(double which, Random& random) {
  return pairOf(which == 2 ? anyShape : triangleShape, which == 1 ? anyShape : triangleShape, random);
}

HardCase convexCase(double, Random& random) {
  return pairOf(convexShape, convexShape, random);
}

HardCase nonConvexCase(double, Random& random) {
  return pairOf(nonConvexShape, nonConvexShape, random);
}

HardCase openCase(double cells, Random& random) {
  HardCase hard = pairOf(random.oneIn(3) ? anyShape : openShape, openShape, random);
  if (random.oneIn(2)) {
    hard.objects[0].mesh = makeSheet(static_cast<uint32_t>(cells), random.oneIn(2) ? 0 : 0.3, random);
  }
  return hard;
}

HardCase crossingCase(double copies, Random& random) {
  HardCase hard = pairOf(anyShape, copies == 1 ? crossingShape : anyShape, random);
  MeshData& mesh = hard.objects[0].mesh;
  const MeshData once = mesh;
  for (int i = 1; i < copies; ++i) append(mesh, once, {});
  if (random.oneIn(2)) hard.sensor.mesh = mesh;
  return hard;
}

HardCase tiesCase(double objects, Random& random) {
  HardCase hard;
  const auto count = static_cast<uint32_t>(objects);
  uint32_t side = 1;
  while (side * side < count) ++side;
  const double gap = 0.5 * (1 + random.below(4));
  hard.sensor.mesh = random.oneIn(2) ? makePlate(side, side, 0.5) : makeSheet(1, 0, random);
  const bool flat = hard.sensor.mesh.triangleCount() == 2;
  if (flat) hard.sensor.worldFromMesh = makePose(kUpright, {0.5 * side, 0.5 * side, 1}, {});
  const MeshData object = random.oneIn(2) ? resized(makeUvSphere(2, 4), 0.25) : makeBox({0.5, 0.5, 0.5});
  const double height = (flat ? 0 : 0.25) + gap + 0.25;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t column = i % side, row = i / side;
    hard.objects.push_back({object, placedAt({column + 0.5 * (1.0 - side), row + 0.5 * (1.0 - side), height})});
  }
  hard.distance = random.oneIn(3) ? gap : gap + 1;
  return hard;
}

HardCase interlockingCase(double which, Random& random) {
  static const std::vector<Interlocked> shapes = interlockedShapes();
  const Interlocked& pair = shapes[static_cast<size_t>(which)];
  const double angle = random.oneIn(7) ? 0 : random.magnitude(-6, -1);
  HardCase hard;
  hard.sensor = {pair.first, makePose(random.slightRotation(angle), kFull, {})};
  const Rotation second = product(random.slightRotation(angle), pair.rotation);
  hard.objects.push_back({pair.second, makePose(second, kFull, pair.offset)});
  hard.direction = random.oneIn(2) ? random.axis() : random.direction();
  hard.distance = random.uniform(0.1, 8);
  return hard;
}

/// 10^first, 10^(first + step) ... 10^last.
std::vector<double> powers(int first, int last) {
  std::vector<double> values;
  for (int k = first; k != last; k += first < last ? 1 : -1) values.push_back(powerOfTen(k));
  values.push_back(powerOfTen(last));
  return values;
}

std::vector<double> zeroAnd(std::vector<double> values) {
  values.insert(values.begin(), 0);
  return values;
}

HardFamily atRest(const char* name, HardCase (*make)(double, Random&)) {
  const char* how = "bodies at rest: 0 on a grid, 1 by quarter turns, 2 turned at random, 3 and scaled and far away";
  return {name, how, {0, 1, 2, 3}, make, true, true};
}

}  // namespace

const std::vector<HardFamily>& hardFamilies() {
  static const std::vector<HardFamily> families{
      {"thin", "width of a rod, in pixels of a 64 x 64 scope", powers(0, -6), thinCase},
      {"edge-on", "angle between a plate and the motion, radians", zeroAnd(powers(-1, -12)), edgeOnCase},
      {"slope", "slope of a face over the plane across the motion", {5, 10, 100, 1e3, 1e4, 1e5}, slopeCase},
      {"touching", "contact exactly: 0 at the start, 1 in flight, 2 at D", {0, 1, 2}, touchingCase},
      {"ulp", "units in the last place by which an exact contact is missed", {-1, 0, 1, 2}, ulpCase, true},
      {"near", "sideways gap of a near miss, or overlap of a near hit", powers(-3, -9), nearCase},
      {"depth", "depth of the initial overlap", powers(0, -9), depthCase},
      {"ties", "objects hit at exactly the same t", {2, 4, 16, 64}, tiesCase},
      {"lattice",
       "whole corners and directions: 0 as they are, 1 turned, 2 and scaled and far away, 3 and poses off by roundings",
       {0, 1, 2, 3},
       latticeCase,
       true},
      {"containment", "size of the inner shape, of the outer one", {0.9, 0.5, 0.1, 0.01}, containmentCase},
      {"interlocking",
       "0 ring on peg, 1 ring through ring, 2 hook behind bar, 3 ball in cup, 4 comb in comb, 5 ball in teapot, "
       "6 key in keyhole",
       {0, 1, 2, 3, 4, 5, 6},
       interlockingCase},
      {"convex", "", {0}, convexCase},
      {"non-convex", "", {0}, nonConvexCase},
      {"open", "cells along the side of an open sheet", {1, 2, 4, 8, 16}, openCase},
      {"crossing", "1 surfaces that cross themselves, 2 and 3 as many copies in one place", {1, 2, 3}, crossingCase},
      {"soup", "0 plain, 1 needles, 2 degenerate, 3 lattice, 4 tiny, 5 far", {0, 1, 2, 3, 4, 5}, soupCase},
      {"single", "one triangle: 0 as sensor and scene, 1 as sensor, 2 as scene", {0, 1, 2}, singleCase},
      {"degenerate",
       "0 points, 1 segments, 2 doubled corners, 3 spikes, 4 slivers, 5 duplicates",
       {0, 1, 2, 3, 4, 5},
       degenerateCase},
      {"far pose", "distance from the origin, by the pose", powers(1, 7), farPosedCase, true},
      {"far baked", "distance from the origin, in the vertices", powers(1, 7), farBakedCase, true},
      {"scale", "size of everything", powers(-4, 4), scaleCase},
      {"floor", "size of a sensor beside a floor of 10^4", powers(0, -2), floorCase},
      {"direction", "how far the direction is off an axis", zeroAnd(powers(-2, -12)), directionCase},
      {"distance", "D", {0, 1e-300, 1e-12, 1e-6, 1, 1e6, 1e12}, distanceCase},
      atRest("assembly", assemblyCase),
      atRest("stacked", stackedCase),
      atRest("corner", cornerCase),
      atRest("peg", pegCase),
      {"sunk",
       "by how much bodies at rest may sink into the sensor",
       {0.5, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15},
       sunkCase,
       true,
       true,
       true}};
  return families;
}

}  // namespace radar::tools
