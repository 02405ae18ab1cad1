#include "workloads/generate.h"

#include <cmath>

#include "workloads/city.h"
#include "workloads/clearance.h"

namespace radar::tools {

namespace {

constexpr int kTries = 64;
constexpr double kTable1Distance = 10;
constexpr double kScaleVolumePerBox = kCubeSide * kCubeSide * kCubeSide / 10'000;
constexpr double kVolumePerMesh = 200;

double lengthOf(const Vec3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Vec3 cubeCorner(double side) {
  return {0.5 * side, 0.5 * side, 0.5 * side};
}

Vec3 negated(const Vec3& v) {
  return {-v[0], -v[1], -v[2]};
}

/// The pose that turns a mesh, scales it alike in all directions and puts the middle of its box at `at`.
Transform poseAround(const MeshExtent& extent, const std::array<double, 9>& rotation, double scale, const Vec3& at) {
  Transform pose = makePose(rotation, {scale, scale, scale}, at);
  for (int row = 0; row < 3; ++row) {
    double* r = &pose.m[4 * row];
    r[3] -= r[0] * extent.middle[0] + r[1] * extent.middle[1] + r[2] * extent.middle[2];
  }
  return pose;
}

/// Shrinks or grows a mesh to a random size; a mesh that is one point stays.
double randomScale(Random& random, const MeshExtent& extent) {
  const double longest = random.uniform(1, 3);
  return extent.longest == 0 ? 1 : longest / extent.longest;
}

/// A place in the cube where a sphere is free, if kTries find one.
Vec3 freePlace(Random& random, const Clearance& clearance, double side, double radius) {
  Vec3 at{};
  for (int i = 0; i < kTries; ++i) {
    at = random.inBox(negated(cubeCorner(side)), cubeCorner(side));
    if (clearance.isFree(at, radius)) break;
  }
  return at;
}

/// Unit box, mesh 0, in every instance: {edges, rotation, place} at random.
std::vector<Instance> randomBoxes(Random& random, uint32_t count, double side, double least, double most,
                                  Clearance& clearance) {
  std::vector<Instance> boxes;
  boxes.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 edges = random.inBox({least, least, least}, {most, most, most});
    const auto rotation = random.rotation();
    const Vec3 at = random.inBox(negated(cubeCorner(side)), cubeCorner(side));
    boxes.push_back({0, makePose(rotation, edges, at)});
    clearance.add(at, 0.5 * lengthOf(edges));
  }
  return boxes;
}

/// Table 1's sensors: unit box, mesh 0, or teapot, mesh 1. `placeFor` finds a place for a sphere of the radius given.
template <class PlaceFor>
void addSensors(Workload& workload, Random& random, uint32_t count, SensorShape shape, const PlaceFor& placeFor) {
  const MeshExtent teapot = extentOf(workload.meshes[1]);
  for (uint32_t i = 0; i < count; ++i) {
    QuerySpec query;
    query.id = "sensor/" + std::to_string(i);
    const auto rotation = random.rotation();
    const Vec3 edges = random.inBox({1, 1, 1}, {3, 3, 3});
    if (shape == SensorShape::box) {
      const Vec3 at = placeFor(0.5 * lengthOf(edges));
      query.sensor = {0, makePose(rotation, edges, at)};
    } else {
      const double scale = 3 / teapot.longest;
      const Vec3 at = placeFor(scale * teapot.radius);
      query.sensor = {1, poseAround(teapot, rotation, scale, at)};
    }
    query.direction = random.direction();
    query.distance = kTable1Distance;
    workload.queries.push_back(std::move(query));
  }
}

Workload boxesAndSensors(uint32_t boxes, uint32_t sensors, SensorShape shape, double side, uint64_t seed) {
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makeTeapot()};
  Random boxRandom(seed), sensorRandom(seed + 1'000'003);
  Clearance clearance(3);
  workload.scenes.push_back({"boxes", {}, randomBoxes(boxRandom, boxes, side, 0.3, 1.5, clearance), {}});
  addSensors(workload, sensorRandom, sensors, shape,
             [&](double radius) { return freePlace(sensorRandom, clearance, side, radius); });
  return workload;
}

/// Where a Figure 7 teapot is and where it is heading.
struct Flight {
  std::array<double, 9> rotation;
  Vec3 at, heading;
};

constexpr double kTeapotWidth = 5, kStep = 1, kLookAhead = 15;

bool canBeAt(const Vec3& at, double radius, const Clearance& boxes, const std::vector<Flight>& flights, size_t self) {
  for (double coordinate : at) {
    if (std::abs(coordinate) > 0.5 * kCubeSide) return false;
  }
  for (size_t i = 0; i < flights.size(); ++i) {
    if (i != self && spheresTouch(at, radius, flights[i].at, radius)) return false;
  }
  return boxes.isFree(at, radius);
}

Vec3 stepFrom(const Vec3& at, const Vec3& heading) {
  return {at[0] + kStep * heading[0], at[1] + kStep * heading[1], at[2] + kStep * heading[2]};
}

/// One step on; where something is in the way, a new heading, and where none of kTries is free, no step.
void fly(std::vector<Flight>& flights, size_t self, double radius, const Clearance& boxes, Random& random) {
  Flight& flight = flights[self];
  for (int i = 0; i < kTries; ++i) {
    const Vec3 next = stepFrom(flight.at, flight.heading);
    if (canBeAt(next, radius, boxes, flights, self)) {
      flight.at = next;
      return;
    }
    flight.heading = random.direction();
  }
}

}  // namespace

Transform normalised(Soup soup, const Transform& pose) {
  Transform result = pose;
  for (int row = 0; row < 3; ++row) {
    double* r = &result.m[4 * row];
    if (soup == Soup::tiny) {
      for (int k = 0; k < 3; ++k) r[k] *= 1e6;
    }
    if (soup == Soup::far) r[3] -= 2000 * (r[0] + r[1] + r[2]);
  }
  return result;
}

Workload makeWorkload(const Table1& options) {
  return boxesAndSensors(options.boxes, options.sensors, options.shape, kCubeSide, options.seed);
}

Workload makeWorkload(const Scale& options) {
  // cbrt is not the same everywhere; a side rounded to 1/64 is.
  const double side = std::round(64 * std::cbrt(kScaleVolumePerBox * options.boxes)) / 64;
  return boxesAndSensors(options.boxes, options.sensors, options.shape, side, options.seed);
}

Workload makeWorkload(const Figure7& options) {
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makeTeapot()};
  const MeshExtent teapot = extentOf(workload.meshes[1]);
  const double scale = kTeapotWidth / teapot.longest, radius = scale * teapot.radius;
  Random random(options.seed);
  Clearance clearance(8);
  workload.scenes.push_back({"boxes", {}, randomBoxes(random, options.boxes, kCubeSide, 0.8, 3, clearance), {}});

  std::vector<Flight> flights;
  for (uint32_t i = 0; i < options.teapots; ++i) {
    Flight flight{random.rotation(), {}, random.direction()};
    for (int attempt = 0; attempt < kTries; ++attempt) {
      flight.at = freePlace(random, clearance, kCubeSide, radius);
      if (canBeAt(flight.at, radius, clearance, flights, flights.size())) break;
    }
    flights.push_back(flight);
  }
  for (uint32_t step = 0; step < options.steps; ++step) {
    SceneSpec scene{"step/" + std::to_string(step), 0, {}, {}};
    const uint32_t sceneNumber = static_cast<uint32_t>(workload.scenes.size());
    for (uint32_t i = 0; i < options.teapots; ++i) {
      QuerySpec query;
      query.id = scene.id + "/teapot/" + std::to_string(i);
      query.scene = sceneNumber;
      query.batch = step;
      query.sensor = {1, poseAround(teapot, flights[i].rotation, scale, flights[i].at)};
      query.exclude = {options.boxes + i};
      query.direction = flights[i].heading;
      query.distance = kLookAhead;
      query.speed = kStep;
      scene.instances.push_back(query.sensor);
      workload.queries.push_back(std::move(query));
    }
    workload.scenes.push_back(std::move(scene));
    for (size_t i = 0; i < flights.size(); ++i) fly(flights, i, radius, clearance, random);
  }
  return workload;
}

Workload makeWorkload(const OneMesh& options) {
  Random random(options.seed), sensorRandom(options.seed + 1'000'003);
  const City city(static_cast<uint32_t>(std::sqrt(0.5 * options.triangles)), random);
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makeTeapot(), city.mesh()};
  workload.scenes.push_back({"city", {}, {{2, {}}}, {}});
  addSensors(workload, sensorRandom, options.sensors, options.shape, [&](double radius) {
    const double edge = city.halfSide();
    Vec3 at = sensorRandom.inBox({-edge, -edge, 0.5}, {edge, edge, 6});
    at[2] += radius + city.highestNear(at[0], at[1], radius);
    return at;
  });
  return workload;
}

Workload makeWorkload(const Sheets& options) {
  Random random(options.seed);
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makeSheet(100, 0.05, random)};
  Clearance clearance(3);
  workload.scenes.push_back({"boxes", {}, randomBoxes(random, options.boxes, kCubeSide, 0.3, 1.5, clearance), {}});
  for (uint32_t i = 0; i < options.sensors; ++i) {
    QuerySpec query;
    query.id = "sensor/" + std::to_string(i);
    const auto rotation = random.rotation();
    // Across the sheet, towards the cube's middle.
    query.direction = {-rotation[2], -rotation[5], -rotation[8]};
    const double half = 0.5 * kCubeSide;
    query.sensor = {1, makePose(rotation, {half, half, half},
                                {2 * half * rotation[2], 2 * half * rotation[5], 2 * half * rotation[8]})};
    query.distance = 2 * kCubeSide;
    workload.queries.push_back(std::move(query));
  }
  return workload;
}

Workload makeWorkload(const Soups& options) {
  Workload workload;
  Random random(options.seed);
  const auto kindOf = [&](uint32_t i) { return options.kinds[i % options.kinds.size()]; };
  const Vec3 origin{options.origin, options.origin, options.origin};
  const auto randomPlace = [&](double reach) {
    Vec3 at = random.inBox({-reach, -reach, -reach}, {reach, reach, reach});
    for (int k = 0; k < 3; ++k) at[k] += origin[k];
    return at;
  };
  for (uint32_t i = 0; i < options.kinds.size(); ++i) {
    workload.meshes.push_back(makeSoup(kindOf(i), options.triangles, random));
  }
  const auto instanceOf = [&](uint32_t i, double reach) {
    const uint32_t mesh = static_cast<uint32_t>(i % options.kinds.size());
    return Instance{mesh, normalised(kindOf(i), randomAffine(random, randomPlace(reach)))};
  };
  SceneSpec scene{"soup", {}, {}, {}};
  for (uint32_t i = 0; i < options.objects; ++i) scene.instances.push_back(instanceOf(i, 8));
  workload.scenes.push_back(std::move(scene));
  for (uint32_t i = 0; i < options.sensors; ++i) {
    QuerySpec query;
    query.id = "sensor/" + std::to_string(i);
    // Kinds of sensor and object meet in all combinations, not only each with itself.
    query.sensor = instanceOf(i + i / static_cast<uint32_t>(options.kinds.size()), 10);
    query.direction = random.direction();
    const double length = random.uniform(0.01, 100);
    for (double& value : query.direction) value *= length;
    query.distance = random.uniform(0, 12);
    workload.queries.push_back(std::move(query));
  }
  return workload;
}

Workload makeWorkload(const RandomPoses& options) {
  Workload workload;
  workload.meshes = options.meshes;
  Random random(options.seed);
  std::vector<MeshExtent> bounds;
  for (const MeshData& mesh : workload.meshes) bounds.push_back(extentOf(mesh));
  const double side = std::round(64 * std::cbrt(kVolumePerMesh * options.objects)) / 64;
  const uint32_t kinds = static_cast<uint32_t>(bounds.size());
  Clearance clearance(4);
  SceneSpec scene{"meshes", {}, {}, {}};
  for (uint32_t i = 0; i < options.objects; ++i) {
    const MeshExtent& mesh = bounds[i % kinds];
    const double scale = randomScale(random, mesh);
    const auto rotation = random.rotation();
    const Vec3 at = random.inBox(negated(cubeCorner(side)), cubeCorner(side));
    scene.instances.push_back({i % kinds, poseAround(mesh, rotation, scale, at)});
    clearance.add(at, scale * mesh.radius);
  }
  workload.scenes.push_back(std::move(scene));
  for (uint32_t i = 0; i < options.sensors; ++i) {
    const MeshExtent& mesh = bounds[i % kinds];
    const double scale = randomScale(random, mesh);
    QuerySpec query;
    query.id = "sensor/" + std::to_string(i);
    const auto rotation = random.rotation();
    const Vec3 at = freePlace(random, clearance, side, scale * mesh.radius);
    query.sensor = {i % kinds, poseAround(mesh, rotation, scale, at)};
    query.direction = random.direction();
    query.distance = kTable1Distance;
    workload.queries.push_back(std::move(query));
  }
  return workload;
}

}  // namespace radar::tools
