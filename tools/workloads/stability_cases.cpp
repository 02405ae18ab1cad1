#include "workloads/stability_cases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "workloads/family_shapes.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

Transform at(double x, double y, double z) {
  return makePose(kUpright, kFull, {x, y, z});
}

/// About x, by the angle of that tangent.
Rotation tilt(double tangent) {
  const double c = 1 / std::sqrt(1 + tangent * tangent), s = c * tangent;
  return {1, 0, 0, 0, c, -s, 0, s, c};
}

/// About z.
Rotation roll(Random& random) {
  const auto [c, s] = circlePoint(random.below(360), 360);
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

MeshData resized(MeshData mesh, double factor) {
  for (float& value : mesh.positions) value = static_cast<float>(value * factor);
  return mesh;
}

/// A D that a contact after about `gap` may lie beyond.
double reachFor(double gap, Random& random) {
  constexpr std::array<double, 4> kParts{0.7, 1.5, 3, 20};
  return gap * kParts[random.below(4)];
}

/// Something solid, about 1 wide, in any pose around `middle`.
PlacedMesh compact(Random& random, const Vec3& middle) {
  const uint32_t which = random.below(4);
  MeshData mesh = which == 0   ? makeBox({1, 0.8, 0.6})
                  : which == 1 ? makeUvSphere(5, 8)
                  : which == 2 ? makeTorus(0.4, 0.15, 12, 6)
                               : makeHook(1, 0.5, 0.4, 0.15);
  if (which == 1) mesh = resized(std::move(mesh), 0.5);
  const auto rotation = random.oneIn(3) ? kUpright : random.rotation();
  return {std::move(mesh), makePose(rotation, kFull, middle)};
}

/// Two shapes of any kind, the sensor below the object, in the way more often than not.
StabilityCase anyPair(Random& random) {
  StabilityCase made;
  made.sensor.mesh = anyShape(random);
  const auto sensorFrame = random.rotation();
  made.sensor.worldFromMesh = makePose(sensorFrame, kFull, {});
  MeshData object = anyShape(random);
  const auto objectFrame = random.rotation();
  const Vec3 where = random.inBox({-1.2, -1.2, 0.5}, {1.2, 1.2, 5});
  made.objects.push_back({std::move(object), makePose(objectFrame, kFull, where)});
  made.distance = reachFor(where[2], random);
  return made;
}

/// Blocks that touch sideways along as many of x and y as `grazing` says, `gap` apart along z; D is three more.
StabilityCase blocks(uint32_t grazing, double gap, Random& random) {
  const Block a = block(random), b = block(random);
  Vec3 where{0, 0, a.reach[2] + b.reach[2] + gap};
  const uint32_t first = random.below(2);
  for (uint32_t k = 0; k < 2; ++k) {
    const bool touches = grazing > (k == first ? 0u : 1u);
    where[k] = touches ? a.reach[k] + b.reach[k] : 0.25 * random.below(3);
    if (random.oneIn(2)) where[k] = -where[k];
  }
  return {{a.mesh, {}}, {{b.mesh, at(where[0], where[1], where[2])}}, {0, 0, 1}, std::max(gap, 0.0) + 3};
}

double stepped(double value, int ulps) {
  for (; ulps > 0; --ulps) value = std::nextafter(value, INFINITY);
  for (; ulps < 0; ++ulps) value = std::nextafter(value, -INFINITY);
  return value;
}

Transform scaledBy(const Transform& pose, double factor) {
  Transform out = pose;
  for (double& value : out.m) value *= factor;
  return out;
}

}  // namespace

void place(StabilityCase& made, const Rotation& frame, const Vec3& origin) {
  const auto move = [&](Transform& pose) {
    const Transform old = pose;
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 4; ++column) {
        double sum = column == 3 ? origin[row] : 0;
        for (size_t k = 0; k < 3; ++k) sum += frame[3 * row + k] * old.m[4 * k + column];
        pose.m[4 * row + column] = sum;
      }
    }
  };
  move(made.sensor.worldFromMesh);
  for (PlacedMesh& object : made.objects) move(object.worldFromMesh);
  made.direction = turned(frame, made.direction);
}

void placeAnywhere(StabilityCase& made, Random& random) {
  if (random.oneIn(2)) {
    const Rotation frame = quarterTurns(random);
    const Vec3 origin = wholeVector(random, 8);
    place(made, frame, origin);
  } else {
    const auto frame = random.rotation();
    const Vec3 origin = random.inBox({-10, -10, -10}, {10, 10, 10});
    place(made, frame, origin);
  }
}

StabilityCase thinCase(double pixels, Random& random) {
  const double width = pixels * 2 / 64, gap = random.uniform(0.2, 4);
  StabilityCase made{{makePlate(2, 2, 0.5), {}}, {}, {0, 0, 1}, 0};
  MeshData rod = makeRod(0.5 * width, 1, 6);
  if (random.oneIn(2)) {
    rod.positions = {static_cast<float>(-0.5 * width), 0, -0.5, static_cast<float>(0.5 * width), 0, -0.5, 0, 0, 0.5};
    rod.indices = {0, 1, 2};
  }
  const auto rotation = random.oneIn(3) ? kUpright : random.oneIn(2) ? kOnEdge : random.rotation();
  const Vec3 where = random.inBox({-0.9, -0.9, 0.75 + gap}, {0.9, 0.9, 0.75 + gap});
  made.objects.push_back({std::move(rod), makePose(rotation, kFull, where)});
  made.distance = reachFor(gap, random);
  return made;
}

StabilityCase edgeOnCase(double angle, Random& random) {
  const double gap = random.uniform(0.2, 3);
  const auto upright = [&] { return product(product(tilt(angle), kOnEdge), roll(random)); };
  StabilityCase made;
  const MeshData sheet = makeSheet(1 + random.below(3), 0, random);
  const Rotation frame = upright();
  const double x = random.uniform(-0.4, 0.4), y = random.uniform(-0.4, 0.4);
  made.objects.push_back({sheet, makePose(frame, kFull, {x, y, 1.5 + gap})});
  made.sensor = compact(random, {});
  if (random.oneIn(2)) {  // another plate edge-on: in the same plane, or across
    const Rotation turnedFrame = upright();
    const Rotation quarter{0, -1, 0, 1, 0, 0, 0, 0, 1};
    const bool across = random.oneIn(2);
    made.sensor = {sheet, makePose(across ? product(quarter, turnedFrame) : turnedFrame, kFull, {x, y, 0})};
  }
  made.distance = reachFor(gap + 1, random);
  return made;
}

StabilityCase slopeCase(double degrees, Random& random) {
  constexpr std::array<std::pair<double, double>, 6> kTangents{{{80, 5.671281819617709},
                                                                {85, 11.430052302761343},
                                                                {89, 57.28996163075943},
                                                                {89.9, 572.9572133542877},
                                                                {89.99, 5729.577893130590},
                                                                {89.999, 57295.77950721740}}};
  const auto known = std::find_if(kTangents.begin(), kTangents.end(), [&](auto& t) { return t.first == degrees; });
  StabilityCase made;
  made.sensor = compact(random, {});
  const Rotation frame = product(roll(random), tilt(known->second));
  const double gap = random.uniform(3, 6);
  const Vec3 where = random.inBox({-0.3, -0.3, gap}, {0.3, 0.3, gap});
  made.objects.push_back({makeSheet(1 + random.below(4), 0, random), makePose(frame, {2, 2, 2}, where)});
  made.distance = reachFor(gap, random);
  return made;
}

StabilityCase touchingCase(double when, Random& random) {
  const double gap = when == 0 ? 0 : 0.5 * (1 + random.below(4));
  StabilityCase made = blocks(random.below(3), gap, random);
  if (when == 0 && random.oneIn(3)) {  // side by side from the start: faces in one plane along the motion
    made = blocks(1 + random.below(2), -0.5, random);
  }
  if (when == 2) made.distance = gap;
  if (when == 0 && random.oneIn(3)) made.distance = 0;
  return made;
}

StabilityCase ulpCase(double ulps, Random& random) {
  const double gap = 0.5 * random.below(4);
  StabilityCase made = blocks(random.below(3), gap, random);
  const bool atEnd = random.oneIn(3);
  if (atEnd) made.distance = gap;
  const Rotation frame = random.oneIn(3) ? random.rotation() : quarterTurns(random);
  place(made, frame, {});
  if (atEnd && random.oneIn(2)) {
    made.distance = std::max(0.0, stepped(made.distance, static_cast<int>(-ulps)));
  } else {
    double& moved = made.objects[0].worldFromMesh.m[4 * random.below(3) + 3];
    moved = stepped(moved, static_cast<int>(moved < 0 ? -ulps : ulps));
  }
  return made;
}

StabilityCase nearCase(double gap, Random& random) {
  const double along = 0.5 * random.below(4);
  const uint32_t grazing = random.below(3);
  StabilityCase made = blocks(grazing, along, random);
  const double side = random.oneIn(2) ? gap : -gap;
  double* where = made.objects[0].worldFromMesh.m.data();
  if (grazing == 0) {
    made.distance = along;
    where[11] += side;
  } else {
    for (size_t k : {3, 7}) where[k] += where[k] < 0 ? -side : side;
  }
  return made;
}

StabilityCase depthCase(double depth, Random& random) {
  StabilityCase made = blocks(random.below(2), -depth, random);
  const double sideways = random.uniform(0, 1.5 * depth);
  double& x = made.objects[0].worldFromMesh.m[3];
  x -= x < 0 ? -sideways : sideways;
  if (random.oneIn(3)) made.direction = random.direction();
  if (random.oneIn(4)) made.distance = 0;
  return made;
}

StabilityCase containmentCase(double ratio, Random& random) {
  StabilityCase made;
  const uint32_t outer = random.below(3);
  MeshData shell = outer == 0 ? makeBox({2, 2, 2}) : outer == 1 ? makeUvSphere(6, 10) : makeCup(1, 2, 0.1, 16);
  const double middle = outer == 2 ? 1 : 0, room = 0.5 * (1 - ratio);
  made.sensor = compact(random, random.inBox({-room, -room, middle - room}, {room, room, middle + room}));
  double* m = made.sensor.worldFromMesh.m.data();
  for (size_t i = 0; i < 12; ++i) m[i] *= i % 4 == 3 ? 1 : ratio;
  made.objects.push_back({std::move(shell), {}});
  made.direction = random.oneIn(2) ? axis(random) : random.direction();
  made.distance = random.uniform(0.1, 3);
  return made;
}

StabilityCase degenerateCase(double kind, Random& random) {
  StabilityCase made = anyPair(random);
  const auto shape = static_cast<uint32_t>(kind);
  made.objects[0].mesh = degenerateShape(shape, random);
  if (random.oneIn(3)) made.sensor.mesh = degenerateShape(shape, random);
  return made;
}

StabilityCase farPosedCase(double distance, Random& random) {
  StabilityCase made = anyPair(random);
  const Vec3 origin = scaled(random.direction(), distance);
  place(made, kUpright, origin);
  return made;
}

StabilityCase farBakedCase(double distance, Random& random) {
  StabilityCase made = anyPair(random);
  const Vec3 origin = scaled(random.direction(), distance);
  const bool back = random.oneIn(2);
  const auto bake = [&](PlacedMesh& placed) {
    MeshData moved{placed.mesh.name, {}, {}};
    append(moved, placed.mesh, origin);
    placed.mesh = std::move(moved);
    for (size_t row = 0; row < 3; ++row) {
      double* r = &placed.worldFromMesh.m[4 * row];
      r[3] -= r[0] * origin[0] + r[1] * origin[1] + r[2] * origin[2] - (back ? 0 : origin[row]);
    }
  };
  bake(made.sensor);
  bake(made.objects[0]);
  return made;
}

StabilityCase scaleCase(double scale, Random& random) {
  StabilityCase made = anyPair(random);
  made.sensor.worldFromMesh = scaledBy(made.sensor.worldFromMesh, scale);
  made.objects[0].worldFromMesh = scaledBy(made.objects[0].worldFromMesh, scale);
  made.distance *= scale;
  return made;
}

StabilityCase floorCase(double size, Random& random) {
  StabilityCase made;
  const Vec3 above = random.inBox({-9e3, -9e3, -3}, {9e3, 9e3, -size});
  made.sensor = compact(random, {});
  made.sensor.worldFromMesh = scaledBy(made.sensor.worldFromMesh, size);
  for (size_t k = 0; k < 3; ++k) made.sensor.worldFromMesh.m[4 * k + 3] = above[k];
  made.objects.push_back({makeSheet(1 + random.below(8), 0, random), makePose(kUpright, {1e4, 1e4, 1e4}, {})});
  if (random.oneIn(3)) made.direction = {1, 0, powerOfTen(-static_cast<int>(random.below(7)))};
  if (random.oneIn(4)) made.direction = random.direction();
  made.distance = random.oneIn(2) ? 1e5 : random.uniform(0, 4);
  return made;
}

StabilityCase directionCase(double off, Random& random) {
  const double gap = 0.5 * random.below(4);
  StabilityCase made = blocks(random.below(3), gap, random);
  if (random.oneIn(2)) made.objects[0].mesh = makeRod(0.2, 2, 8);
  const Vec3 aside = random.direction();
  for (size_t k = 0; k < 3; ++k) made.direction[k] += random.oneIn(3) ? 0 : off * aside[k];
  made.direction = scaled(made.direction, magnitude(random, -12, 12));
  made.distance += random.uniform(0, 3);
  return made;
}

StabilityCase distanceCase(double distance, Random& random) {
  StabilityCase made = random.oneIn(2) ? anyPair(random) : blocks(random.below(3), 0, random);
  if (random.oneIn(3)) made.objects[0].worldFromMesh.m[11] += distance;
  made.distance = distance;
  return made;
}

StabilityCase singleCase(double which, Random& random) {
  StabilityCase made = anyPair(random);
  if (which != 2) made.sensor.mesh = triangleShape(random);
  if (which != 1) made.objects[0].mesh = triangleShape(random);
  return made;
}

StabilityCase openCase(double cells, Random& random) {
  StabilityCase made = anyPair(random);
  made.objects[0].mesh = makeSheet(static_cast<uint32_t>(cells), random.oneIn(2) ? 0 : 0.3, random);
  if (random.oneIn(3)) made.sensor.mesh = openShape(random);
  return made;
}

StabilityCase crossingCase(double copies, Random& random) {
  StabilityCase made = anyPair(random);
  MeshData& mesh = made.objects[0].mesh;
  if (copies == 1) {
    mesh = crossingShape(random);
  } else {
    const MeshData once = mesh;
    for (int i = 1; i < copies; ++i) append(mesh, once, {});
  }
  if (random.oneIn(2)) made.sensor.mesh = mesh;
  return made;
}

StabilityCase tiesCase(double objects, Random& random) {
  StabilityCase made;
  const auto count = static_cast<uint32_t>(objects);
  uint32_t side = 1;
  while (side * side < count) ++side;
  const double gap = 0.5 * (1 + random.below(4));
  made.sensor.mesh = random.oneIn(2) ? makePlate(side, side, 0.5) : makeSheet(1, 0, random);
  if (made.sensor.mesh.triangleCount() == 2)
    made.sensor.worldFromMesh = makePose(kUpright, {0.5 * side, 0.5 * side, 1}, {});
  const bool octahedra = random.oneIn(2);
  const MeshData object = octahedra ? resized(makeUvSphere(2, 4), 0.25) : makeBox({0.5, 0.5, 0.5});
  const double face = made.sensor.mesh.triangleCount() == 2 ? 0 : 0.25;
  for (uint32_t i = 0; i < count; ++i) {
    made.objects.push_back(
        {object, at(i % side + 0.5 * (1.0 - side), i / side + 0.5 * (1.0 - side), face + gap + 0.25)});
  }
  made.distance = random.oneIn(3) ? gap : gap + 1;
  return made;
}

StabilityCase interlockedCase(size_t which, double angle, Random& random) {
  static const std::vector<Interlocked> shapes = interlockedShapes();
  const Interlocked& pair = shapes[which];
  StabilityCase made;
  made.sensor = {pair.first, makePose(slightRotation(random, angle), kFull, {})};
  const Rotation second = product(slightRotation(random, angle), pair.rotation);
  made.objects.push_back({pair.second, makePose(second, kFull, pair.offset)});
  made.direction = random.oneIn(2) ? axis(random) : random.direction();
  made.distance = random.uniform(0.1, 8);
  return made;
}

}  // namespace radar::tools
