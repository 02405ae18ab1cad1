#include "workloads/families.h"

#include <cmath>
#include <limits>

#include "workloads/family_shapes.h"
#include "workloads/generate.h"
#include "workloads/placement.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

// Enough in a cube of edge 14 or so that sensors hit, miss and overlap in like numbers.
constexpr int kObjects = 60;

/// A whole direction, along an axis half of the time.
Vec3 wholeDirection(Random& random) {
  if (random.oneIn(2)) return axis(random);
  Vec3 v{};
  while (v == Vec3{}) v = wholeVector(random, 2);
  return v;
}

struct Making {
  Workload workload;
  Random random;
  uint32_t queries;

  uint32_t anyMesh() { return random.below(static_cast<uint32_t>(workload.meshes.size())); }
  void addObject(uint32_t mesh, const Transform& pose) { workload.scenes[0].instances.push_back({mesh, pose}); }
  void ask(uint32_t mesh, const Transform& pose, const Vec3& direction, double distance) {
    QuerySpec query;
    query.id = std::to_string(workload.queries.size());
    query.sensor = {mesh, pose};
    query.direction = direction;
    query.distance = distance;
    workload.queries.push_back(std::move(query));
  }
};

/// Where and how large a scene is.
struct Setting {
  double scale = 1;
  Vec3 origin{};
  Transform placed(const Transform& pose) const {
    Transform out = pose;
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 4; ++k) out.m[4 * row + k] *= scale;
      out.m[4 * row + 3] += origin[row];
    }
    return out;
  }
};

Vec3 farOrigin(Random& random) {
  const double distance = magnitude(random, 1, 7);
  return scaled(random.direction(), distance);
}

/// Objects at random, sensors at random in and around them, so that they hit, miss and overlap.
template <class Shape>
void scatter(Making& making, Shape shape, const Setting& setting = {}) {
  Random& random = making.random;
  for (int i = 0; i < 6; ++i) making.workload.meshes.push_back(shape(random));
  const auto place = [&](double reach) {
    const Vec3 at = random.inBox(scaled(kFull, -reach), scaled(kFull, reach));
    if (random.oneIn(3)) return setting.placed(randomAffine(random, at));
    const double size = random.uniform(0.5, 1.5);
    return setting.placed(makePose(random.rotation(), scaled(kFull, size), at));
  };
  for (int i = 0; i < kObjects; ++i) {
    const uint32_t mesh = making.anyMesh();
    making.addObject(mesh, place(7));
  }
  for (uint32_t i = 0; i < making.queries; ++i) {
    const uint32_t mesh = making.anyMesh();
    const Transform pose = place(9);
    const Vec3 direction = random.direction();
    making.ask(mesh, pose, direction, random.oneIn(10) ? 0 : setting.scale * random.uniform(0, 12));
  }
}

void interlock(Making& making) {
  Random& random = making.random;
  std::vector<Interlocked> shapes = interlockedShapes();
  for (Interlocked& pair : shapes) {
    making.workload.meshes.push_back(std::move(pair.first));
    making.workload.meshes.push_back(std::move(pair.second));
  }
  for (uint32_t i = 0; i < making.queries; ++i) {
    const uint32_t which = random.below(static_cast<uint32_t>(shapes.size())), sensor = random.below(2);
    const Vec3 home{40.0 * (i % 8), 40.0 * (i / 8 % 8), 40.0 * (i / 64)};
    const auto frame = random.rotation();
    Vec3 second = turned(frame, shapes[which].offset);
    for (size_t k = 0; k < 3; ++k) second[k] += home[k];
    const auto slightly = [&] { return product(frame, slightRotation(random, magnitude(random, -6, -1))); };
    const Transform poses[] = {makePose(slightly(), kFull, home),
                               makePose(product(slightly(), shapes[which].rotation), kFull, second)};
    making.addObject(2 * which + 1 - sensor, poses[1 - sensor]);
    const Vec3 direction = random.oneIn(2) ? turned(frame, axis(random)) : random.direction();
    making.ask(2 * which + sensor, poses[sensor], direction, random.uniform(0.1, 8));
  }
}

/// Boxes and triangles with whole corners. `frame`, `setting`: all of it turned and placed; `roundings`: some poses off
/// by a few.
void onLattice(Making& making, const std::array<double, 9>& frame, const Setting& setting, bool roundings) {
  Random& random = making.random;
  making.workload.meshes = {makeBox({1, 1, 1}), makeBox({2, 1, 1}), makePlate(2, 2, 1), makeSheet(2, 0, random)};
  for (int i = 0; i < 3; ++i) {
    MeshData mesh{"triangles", {}, {}};
    for (uint32_t corner = 0, corners = 3 * (1 + random.below(6)); corner < corners; ++corner) {
      for (double value : wholeVector(random, 2)) mesh.positions.push_back(static_cast<float>(value));
      mesh.indices.push_back(corner);
    }
    making.workload.meshes.push_back(std::move(mesh));
  }
  const auto place = [&](uint32_t limit) {
    Transform pose = setting.placed(makePose(frame, kFull, turned(frame, scaled(wholeVector(random, limit), 0.5))));
    if (!roundings) return pose;
    for (double& value : pose.m) {
      if (random.oneIn(4)) value = std::nextafter(value, random.oneIn(2) ? 1e300 : -1e300);
    }
    return pose;
  };
  for (int i = 0; i < kObjects; ++i) {
    const uint32_t mesh = making.anyMesh();
    making.addObject(mesh, place(16));
  }
  for (uint32_t i = 0; i < making.queries; ++i) {
    const uint32_t mesh = making.anyMesh();
    const Transform pose = place(18);
    const Vec3 direction = turned(frame, wholeDirection(random));
    making.ask(mesh, pose, direction, setting.scale * random.below(12));
  }
}

void touch(Making& making) {
  Random& random = making.random;
  const auto frame = random.oneIn(3) ? kUpright : random.rotation();
  const Setting setting{magnitude(random, -3, 3), random.oneIn(2) ? Vec3{} : farOrigin(random)};
  onLattice(making, frame, setting, random.oneIn(2));
}

/// Moves every mesh to `origin` in its own coordinates; a pose takes it back, or leaves it there.
void farBaked(Making& making) {
  scatter(making, anyShape);
  const Vec3 origin = farOrigin(making.random);
  for (MeshData& mesh : making.workload.meshes) {
    MeshData moved{mesh.name, {}, {}};
    append(moved, mesh, origin);
    mesh = std::move(moved);
  }
  const bool back = making.random.oneIn(2);
  const auto move = [&](Transform& pose) {
    for (int row = 0; row < 3; ++row) {
      double* r = &pose.m[4 * row];
      r[3] -= r[0] * origin[0] + r[1] * origin[1] + r[2] * origin[2] - (back ? 0 : origin[row]);
    }
  };
  for (Instance& instance : making.workload.scenes[0].instances) move(instance.worldFromMesh);
  for (QuerySpec& query : making.workload.queries) move(query.sensor.worldFromMesh);
}

void onFloor(Making& making) {
  Random& random = making.random;
  const auto frame = random.oneIn(2) ? kUpright : random.rotation();
  making.workload.meshes.push_back(makeSheet(1 + random.below(8), 0, random));
  for (int i = 0; i < 5; ++i) making.workload.meshes.push_back(anyShape(random));
  making.addObject(0, makePose(frame, {1e4, 1e4, 1e4}, {}));
  for (uint32_t i = 0; i < making.queries; ++i) {
    const Vec3 above = random.inBox({-9e3, -9e3, 0}, {9e3, 9e3, 0.5});
    const uint32_t mesh = 1 + random.below(5);
    const Transform pose = makePose(random.rotation(), {1e-2, 1e-2, 1e-2}, turned(frame, above));
    Vec3 down{0, 0, -1};
    if (random.oneIn(3)) down = {1, 0, -powerOfTen(-static_cast<int>(random.below(7)))};
    if (random.oneIn(3)) down = random.direction();
    making.ask(mesh, pose, turned(frame, down), random.oneIn(2) ? 1e5 : random.uniform(0, 1));
  }
}

void tiltedDirections(Making& making) {
  Random& random = making.random;
  making.workload.meshes = {makeBox({1, 1, 1}), makePlate(2, 2, 0.01), makeRod(0.2, 2, 8), makeSheet(3, 0, random),
                            makeSheet(4, 0.1, random)};
  const auto frame = random.oneIn(2) ? kUpright : random.rotation();
  const auto place = [&](double reach) {
    const Vec3 at = random.oneIn(2) ? scaled(wholeVector(random, static_cast<uint32_t>(2 * reach)), 0.5)
                                    : random.inBox(scaled(kFull, -reach), scaled(kFull, reach));
    return makePose(frame, kFull, turned(frame, at));
  };
  for (int i = 0; i < kObjects; ++i) {
    const uint32_t mesh = making.anyMesh();
    making.addObject(mesh, place(6));
  }
  for (uint32_t i = 0; i < making.queries; ++i) {
    const uint32_t mesh = making.anyMesh();
    const Transform pose = place(8);
    Vec3 direction = axis(random);
    if (!random.oneIn(4)) {
      const double size = magnitude(random, -12, -2);
      const Vec3 off = scaled(random.direction(), size);
      for (size_t k = 0; k < 3; ++k) direction[k] += random.oneIn(3) ? 0 : off[k];
    }
    const double length = magnitude(random, -12, 12);
    making.ask(mesh, pose, scaled(turned(frame, direction), length), random.uniform(0, 12));
  }
}

Workload soups(Making& making) {
  const double origin = making.random.oneIn(2) ? 0 : magnitude(making.random, 1, 7);
  return makeWorkload(Soups{.sensors = making.queries,
                            .triangles = 1 + making.random.below(120),
                            .origin = origin,
                            .seed = making.random.below(~0u)});
}

}  // namespace

const char* nameOf(Family family) {
  constexpr std::array<const char*, kFamilies.size()> kNames{
      "convex",   "non-convex", "interlocking", "open",   "crossing", "soup",      "lattice",
      "touching", "far-posed",  "far-baked",    "scales", "floor",    "directions"};
  return kNames[static_cast<size_t>(family)];
}

Workload makeWorkload(const FamilyScene& options) {
  Making making{{}, Random(options.seed), options.queries};
  making.workload.scenes.push_back({nameOf(options.family), {}, {}, {}});
  switch (options.family) {
    case Family::convex:
      scatter(making, convexShape);
      break;
    case Family::nonConvex:
      scatter(making, nonConvexShape);
      break;
    case Family::interlocking:
      interlock(making);
      break;
    case Family::open:
      scatter(making, openShape);
      break;
    case Family::crossing:
      scatter(making, crossingShape);
      break;
    case Family::soup:
      return soups(making);
    case Family::lattice:
      onLattice(making, kUpright, {}, false);
      break;
    case Family::touching:
      touch(making);
      break;
    case Family::farPosed:
      scatter(making, anyShape, {1, farOrigin(making.random)});
      break;
    case Family::farBaked:
      farBaked(making);
      break;
    case Family::scales:
      scatter(making, anyShape, {magnitude(making.random, -4, 4), {}});
      break;
    case Family::floor:
      onFloor(making);
      break;
    case Family::directions:
      tiltedDirections(making);
      break;
  }
  return std::move(making.workload);
}

}  // namespace radar::tools
