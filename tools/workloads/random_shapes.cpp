// Each random number is stored before it is used, since the compiler chooses the order in which it evaluates arguments.
#include "workloads/random_shapes.h"

#include "workloads/shapes.h"

namespace radar::tools {

namespace {

/// A comb of narrower teeth that hang down between those of makeComb.
MeshData looseComb() {
  MeshData mesh = makeBox({3, 0.3, 0.3});
  for (double x : {-1.0, 0.0, 1.0}) append(mesh, makeBox({0.3, 0.3, 1.5}), {x, 0, -0.9});
  return mesh;
}

MeshData smallBall() {
  return resized(makeUvSphere(8, 12), 0.5);
}

}  // namespace

MeshData convexShape(Random& random) {
  const uint32_t segments = 3 + random.below(16);
  const double size = random.uniform(0.01, 0.5);
  switch (random.below(4)) {
    case 0:
      return makeBox(random.inBox({0.5, 0.5, 0.5}, {2, 2, 2}));
    case 1:
      return makeUvSphere(3 + random.below(8), segments);
    case 2:
      return makeRod(size, random.uniform(1, 3), segments);
    default:
      return makePlate(2, 1, powerOfTen(-static_cast<int>(random.below(6))));
  }
}

MeshData nonConvexShape(Random& random) {
  const uint32_t segments = 4 + random.below(24), tubeSegments = 3 + random.below(8);
  switch (random.below(5)) {
    case 0:
      return makeTorus(1, random.uniform(0.05, 0.4), segments, tubeSegments);
    case 1:
      return makeHook(2, 0.9, 0.7, 0.25);
    case 2:
      return makeComb(2 + random.below(5), 0.5, 1, 0.3);
    case 3:
      return makeCup(1, 1.5, 0.15, segments);
    default:
      return resized(makeTeapot(), 0.375);
  }
}

MeshData openShape(Random& random) {
  switch (random.below(4)) {
    case 0:
      return makeSheet(1 + random.below(12), 0.3, random);
    case 1: {
      const std::array<std::array<double, 2>, 2> profile{{{random.uniform(0.2, 1), -1}, {random.uniform(0.2, 1), 1}}};
      return makeLathe(profile, false, 3 + random.below(16));
    }
    case 2:
      return triangleShape(random);
    default:
      return makeSheet(1, 0, random);
  }
}

MeshData crossingShape(Random& random) {
  if (random.oneIn(3)) {  // a profile that crosses the axis and itself
    const std::array<std::array<double, 2>, 5> profile{{{0, -1}, {1, -0.5}, {-0.5, 0.3}, {0.8, 0.6}, {0, 1}}};
    return makeLathe(profile, false, 3 + random.below(10));
  }
  MeshData mesh = random.oneIn(2) ? convexShape(random) : openShape(random);
  const MeshData again = mesh;
  const double reach = random.oneIn(2) ? 0 : 0.5;  // 0: every triangle twice
  append(mesh, again, random.inCube(reach));
  return mesh;
}

MeshData anyShape(Random& random) {
  switch (random.below(8)) {
    case 0:
    case 1:
      return convexShape(random);
    case 2:
    case 3:
      return nonConvexShape(random);
    case 4:
    case 5:
      return openShape(random);
    case 6:
      return crossingShape(random);
    default: {
      const Soup soup = std::array{Soup::plain, Soup::needles, Soup::degenerate, Soup::lattice}[random.below(4)];
      return makeSoup(soup, 1 + random.below(40), random);
    }
  }
}

MeshData latticeShape(Random& random) {
  switch (random.below(5)) {
    case 0:
      return makeBox({1, 1, 1});
    case 1:
      return makeBox({2, 1, 1});
    case 2:
      return makePlate(2, 2, 1);
    case 3:
      return makeSheet(2, 0, random);
  }
  MeshData mesh{"triangles", {}, {}};
  for (uint32_t corner = 0, corners = 3 * (1 + random.below(6)); corner < corners; ++corner) {
    addVertex(mesh, random.wholeVector(2));
    mesh.indices.push_back(corner);
  }
  return mesh;
}

MeshData triangleShape(Random& random) {
  MeshData mesh{"triangle", {}, {0, 1, 2}};
  for (int i = 0; i < 3; ++i) addVertex(mesh, random.inCube(1));
  return mesh;
}

MeshData degenerateShape(uint32_t kind, Random& random) {
  MeshData mesh{"degenerate", {}, {}};
  for (uint32_t count = 1 + random.below(6); count > 0; --count) {
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) corner = random.inCube(1);
    const auto between = [&](double part, double off) {
      return corners[0] + part * (corners[1] - corners[0]) + off * (corners[2] - corners[0]);
    };
    if (kind == 0) corners[1] = corners[2] = corners[0];
    if (kind == 1) corners[2] = between(random.uniform(-0.5, 1.5), 0);
    if (kind == 2) corners[2] = corners[random.below(2)];
    if (kind == 3) corners = {between(0, 0), between(1000, 0), between(1000, 1e-6)};
    if (kind == 4) corners[2] = between(0.5, random.magnitude(-9, -4));
    MeshData triangle{"", {}, {0, 1, 2}};
    for (const Vec3& corner : corners) addVertex(triangle, corner);
    for (int copy = kind == 5 ? 3 : 1; copy > 0; --copy) append(mesh, triangle, {});
  }
  return mesh;
}

Block block(Random& random) {
  switch (random.below(4)) {
    case 0:
      return {makeBox({1, 1, 1}), {0.5, 0.5, 0.5}};
    case 1:
      return {makeBox({2, 1, 1}), {1, 0.5, 0.5}};
    case 2:
      return {makePlate(2, 2, 1), {1, 1, 0.5}};
    default:
      return {makeUvSphere(2, 4), {1, 1, 1}};  // an octahedron: corners first
  }
}

std::vector<Interlocked> interlockedShapes() {
  return {{makeTorus(1, 0.2, 24, 12), makeRod(0.4, 6, 20), kUpright, {0, 0, 0.1}},
          {makeTorus(1, 0.15, 24, 10), makeTorus(1, 0.15, 24, 10), kOnEdge, {1, 0, 0}},
          {makeHook(4, 1.5, 1, 0.3), makeBox({0.3, 3, 0.3}), kUpright, {0.6, 0, -1.3}},
          {makeCup(1, 2, 0.2, 24), smallBall(), kUpright, {0, 0, 1}},
          {makeComb(4, 1, 1.5, 0.3), looseComb(), kUpright, {0, 0, 1.9}},
          {makeTeapot(), smallBall(), kUpright, {0, 0, 1.2}},
          {makeKeyhole(), makeKey(), kUpright, {0, 0, 0.5}}};
}

}  // namespace radar::tools
