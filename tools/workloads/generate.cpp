#include "workloads/generate.h"

#include <unordered_map>

namespace radar::tools {

namespace {

constexpr int kTries = 64;
constexpr double kTable1Distance = 10;
constexpr double kScaleVolumePerBox = kCubeSide * kCubeSide * kCubeSide / 10'000;
constexpr double kVolumePerMesh = 200;

struct Sphere {
  Vec3 centre{};
  double radius = 0;
  bool touches(const Sphere& other) const {
    const Vec3 between = centre - other.centre;
    const double reach = radius + other.radius;
    return dot(between, between) <= reach * reach;
  }
};

/// Which places in a scene are free, by bounding spheres in a grid of cells. A cell should be about twice the radius of
/// a large sphere.
class Clearance {
 public:
  explicit Clearance(double cell) : cell_(cell) {}

  void add(const Sphere& sphere) {
    largest_ = std::max(largest_, sphere.radius);
    cells_[keyOf(cellOf(sphere.centre[0]), cellOf(sphere.centre[1]), cellOf(sphere.centre[2]))].push_back(sphere);
  }
  /// Whether a sphere touches none of those added.
  bool isFree(const Sphere& sphere) const {
    const double reach = sphere.radius + largest_;
    const auto first = [&](size_t k) { return cellOf(sphere.centre[k] - reach); };
    const auto last = [&](size_t k) { return cellOf(sphere.centre[k] + reach); };
    for (int64_t x = first(0); x <= last(0); ++x) {
      for (int64_t y = first(1); y <= last(1); ++y) {
        for (int64_t z = first(2); z <= last(2); ++z) {
          const auto found = cells_.find(keyOf(x, y, z));
          if (found == cells_.end()) continue;
          for (const Sphere& other : found->second) {
            if (sphere.touches(other)) return false;
          }
        }
      }
    }
    return true;
  }

 private:
  int64_t cellOf(double coordinate) const { return static_cast<int64_t>(std::floor(coordinate / cell_)); }
  static uint64_t keyOf(int64_t x, int64_t y, int64_t z) {
    constexpr int64_t kHalf = 1 << 20;  // 21 bits an axis
    return uint64_t(x + kHalf) << 42 | uint64_t(y + kHalf) << 21 | uint64_t(z + kHalf);
  }

  double cell_;
  double largest_ = 0;
  std::unordered_map<uint64_t, std::vector<Sphere>> cells_;
};

/// The pose that turns a mesh, scales it alike in all directions and puts the middle of its box at `where`.
Transform poseAround(const MeshExtent& extent, const Rotation& rotation, double scale, const Vec3& where) {
  Transform pose = makePose(rotation, {scale, scale, scale}, where);
  moveBy(pose, -1 * turned(linearPart(pose), extent.middle));
  return pose;
}

/// Shrinks or grows a mesh to a random size; a mesh that is one point stays.
double randomScale(Random& random, const MeshExtent& extent) {
  const double longest = random.uniform(1, 3);
  return extent.longest == 0 ? 1 : longest / extent.longest;
}

/// The side of a cube for `count` objects. cbrt is not the same everywhere; a side rounded to 1/64 is.
double sideFor(uint32_t count, double volumeOfEach) {
  return std::round(64 * std::cbrt(volumeOfEach * count)) / 64;
}

/// A place in the cube where a sphere is free, if kTries find one.
Vec3 freePlace(Random& random, const Clearance& clearance, double side, double radius) {
  Vec3 where{};
  for (int i = 0; i < kTries; ++i) {
    where = random.inCube(0.5 * side);
    if (clearance.isFree({where, radius})) break;
  }
  return where;
}

/// A scene of unit boxes, mesh 0, with edges of `least` to `most`.
SceneSpec randomBoxes(Random& random, uint32_t count, double side, double least, double most, Clearance& clearance) {
  SceneSpec scene{"boxes", {}, {}, {}};
  scene.instances.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 edges = random.inBox(least * kFull, most * kFull);
    const Rotation rotation = random.rotation();
    const Vec3 where = random.inCube(0.5 * side);
    scene.instances.push_back({0, makePose(rotation, edges, where)});
    clearance.add({where, 0.5 * lengthOf(edges)});
  }
  return scene;
}

QuerySpec sensorQuery(uint32_t i) {
  QuerySpec query;
  query.id = "sensor/" + std::to_string(i);
  query.distance = kTable1Distance;
  return query;
}

template <class Options>
Workload boxesAndSensors(const Options& options, double side) {
  Workload workload;
  workload.meshes = {makeBox(kFull), makeTeapot()};
  Random boxRandom(options.seed), sensorRandom(options.seed + 1'000'003);
  Clearance clearance(3);
  workload.scenes.push_back(randomBoxes(boxRandom, options.boxes, side, 0.3, 1.5, clearance));
  addSensors(workload, sensorRandom, options.sensors, options.shape,
             [&](double radius) { return freePlace(sensorRandom, clearance, side, radius); });
  return workload;
}

/// A Figure 7 teapot on its way.
struct Flight {
  Rotation rotation;
  Vec3 heading;
  Sphere sphere;
};

constexpr double kTeapotWidth = 5, kStep = 1, kLookAhead = 15;

bool canBeAt(const Sphere& sphere, const Clearance& boxes, const std::vector<Flight>& flights, size_t self) {
  for (double coordinate : sphere.centre) {
    if (std::abs(coordinate) > 0.5 * kCubeSide) return false;
  }
  for (size_t i = 0; i < flights.size(); ++i) {
    if (i != self && sphere.touches(flights[i].sphere)) return false;
  }
  return boxes.isFree(sphere);
}

/// Moves one step on. If something is in the way, tries other headings; after kTries, stays.
void fly(std::vector<Flight>& flights, size_t self, const Clearance& boxes, Random& random) {
  Flight& flight = flights[self];
  for (int i = 0; i < kTries; ++i) {
    const Sphere next{flight.sphere.centre + kStep * flight.heading, flight.sphere.radius};
    if (canBeAt(next, boxes, flights, self)) {
      flight.sphere = next;
      return;
    }
    flight.heading = random.direction();
  }
}

}  // namespace

void addSensors(Workload& workload, Random& random, uint32_t count, SensorShape shape, const PlaceFor& placeFor) {
  const MeshExtent teapot = extentOf(workload.meshes[1]);
  for (uint32_t i = 0; i < count; ++i) {
    QuerySpec query = sensorQuery(i);
    const Rotation rotation = random.rotation();
    const Vec3 edges = random.inBox(kFull, 3 * kFull);
    if (shape == SensorShape::box) {
      query.setSensor({0, makePose(rotation, edges, placeFor(0.5 * lengthOf(edges)))});
    } else {
      const double scale = 3 / teapot.longest;
      query.setSensor({1, poseAround(teapot, rotation, scale, placeFor(scale * teapot.radius))});
    }
    query.direction = random.direction();
    workload.queries.push_back(std::move(query));
  }
}

Workload makeWorkload(const Table1& options) {
  return boxesAndSensors(options, kCubeSide);
}

Workload makeWorkload(const Scale& options) {
  return boxesAndSensors(options, sideFor(options.boxes, kScaleVolumePerBox));
}

Workload makeWorkload(const Figure7& options) {
  Workload workload;
  workload.meshes = {makeBox(kFull), makeTeapot()};
  const MeshExtent teapot = extentOf(workload.meshes[1]);
  const double scale = kTeapotWidth / teapot.longest;
  Random random(options.seed);
  Clearance clearance(8);
  workload.scenes.push_back(randomBoxes(random, options.boxes, kCubeSide, 0.8, 3, clearance));

  std::vector<Flight> flights;
  for (uint32_t i = 0; i < options.teapots; ++i) {
    Flight flight{random.rotation(), random.direction(), {{}, scale * teapot.radius}};
    for (int attempt = 0; attempt < kTries; ++attempt) {
      flight.sphere.centre = freePlace(random, clearance, kCubeSide, flight.sphere.radius);
      if (canBeAt(flight.sphere, clearance, flights, flights.size())) break;
    }
    flights.push_back(flight);
  }
  for (uint32_t step = 0; step < options.steps; ++step) {
    SceneSpec scene{"step/" + std::to_string(step), 0, {}, {}};
    for (uint32_t i = 0; i < options.teapots; ++i) {
      QuerySpec query;
      query.id = scene.id + "/teapot/" + std::to_string(i);
      query.scene = static_cast<uint32_t>(workload.scenes.size());
      query.batch = step;
      query.setSensor({1, poseAround(teapot, flights[i].rotation, scale, flights[i].sphere.centre)});
      query.exclude = {options.boxes + i};
      query.direction = flights[i].heading;
      query.distance = kLookAhead;
      query.speed = kStep;
      scene.instances.push_back(query.sensor());
      workload.queries.push_back(std::move(query));
    }
    workload.scenes.push_back(std::move(scene));
    for (size_t i = 0; i < flights.size(); ++i) fly(flights, i, clearance, random);
  }
  return workload;
}

Workload makeWorkload(const RandomPoses& options) {
  Workload workload;
  workload.meshes = options.meshes;
  Random random(options.seed);
  std::vector<MeshExtent> extents;
  for (const MeshData& mesh : workload.meshes) extents.push_back(extentOf(mesh));
  const double side = sideFor(options.objects, kVolumePerMesh);
  Clearance clearance(4);
  // Mesh i of the list, repeated; `placeFor` finds a place for a sphere of the radius given.
  const auto instance = [&](uint32_t i, const auto& placeFor) {
    const auto mesh = static_cast<uint32_t>(i % extents.size());
    const double scale = randomScale(random, extents[mesh]);
    const Rotation rotation = random.rotation();
    return Instance{mesh, poseAround(extents[mesh], rotation, scale, placeFor(scale * extents[mesh].radius))};
  };
  SceneSpec scene{"meshes", {}, {}, {}};
  for (uint32_t i = 0; i < options.objects; ++i) {
    scene.instances.push_back(instance(i, [&](double radius) {
      const Vec3 where = random.inCube(0.5 * side);
      clearance.add({where, radius});
      return where;
    }));
  }
  workload.scenes.push_back(std::move(scene));
  for (uint32_t i = 0; i < options.sensors; ++i) {
    QuerySpec query = sensorQuery(i);
    query.setSensor(instance(i, [&](double radius) { return freePlace(random, clearance, side, radius); }));
    query.direction = random.direction();
    workload.queries.push_back(std::move(query));
  }
  return workload;
}

}  // namespace radar::tools
