// How the device describes and places what a host deforms without bounds, against exact arithmetic and what it makes of
// the same vertices in a scene.
#include <bit>
#include <cmath>
#include <deque>

#include "cpu/clearance.h"
#include "embed/host_geometry.h"
#include "embed/on_device.h"
#include "query/swept.h"
#include "support/catch.h"
#include "support/encoded.h"
#include "support/exact_placement.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::bufferOf;
using test::OnDevice;

SearchPlan statedFor(const Scene& scene, std::span<const Query> queries) {
  SearchPlan batch;
  for (const Query& query : queries) {
    REQUIRE(batch.add(query, batch.count(), scene.impl(), scene.impl().objectTree()) == Planned::added);
  }
  return batch;
}

/// What the device writes for queries of the scene in which a host deforms all meshes.
struct OnDevicePlaces : test::Encoded {
  OnDevicePlaces(const Scene& scene, std::span<const DeformedMesh> meshes, std::span<const Query> queries)
      : copy(test::device().impl()) {
    const Device::Impl& device = test::device().impl();
    const Scene::Impl& impl = scene.impl();
    ContactPass search(device, copy, {});
    HostGeometryPass geometry(device, copy);
    geometry.stage({.meshes = meshes}, impl);
    SearchPlan batch = statedFor(scene, queries);
    for (gpu::Sweep& sweep : batch.sweeps) sweep.magnitude = -1;
    const std::vector<Result> known(queries.size());
    search.stage(batch.source(), known, impl, geometry.overwritten());
    Encoded::operator=(test::encodedBy(search, queries.size(),
                                       [&](const gpu::Commands& commands) { geometry.record(commands, impl, 0); }));
    gpu::Submission submission(device, false);
    geometry.recordReadback(submission.begin());
    submission.submitAndWait();
    records = test::elementsOf(copy.buffers().meshes, 0, impl.meshes.size());
    placements = test::elementsOf(copy.buffers().placements, 0, impl.objects.size());
    boxes = geometry.unboundedBoxes();
  }
  GpuScene copy;
  std::vector<gpu::MeshRecord> records;
  std::vector<gpu::Placement> placements;
  std::map<MeshId, Box> boxes;
};

/// The mesh with the device's origin and unit. Its vertices are normalised as they should be.
Mesh asDescribed(Mesh mesh, const gpu::MeshRecord& record) {
  CHECK(record.unit * record.perUnit == 1);
  mesh.unit = record.unit;
  for (size_t k = 0; k < 3; ++k) {
    mesh.origin[k] = record.origin[k];
    for (const uint32_t vertex : mesh.indices) {
      const float position = mesh.positions[3 * size_t{vertex} + k];
      const float local = position - record.origin[k];
      CHECK(double{local} == double{position} - record.origin[k]);
      CHECK((local >= record.lo[k] && local <= record.hi[k]));
      CHECK(std::abs(local * record.perUnit) < 2);
      mesh.local[k][vertex] = local;
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("the device places what a host deforms without bounds as precisely as the CPU places the same vertices") {
  // Exponents of the sizes of the deformed meshes, of their rest poses, and of how far away the scene is.
  struct Exponents {
    double size, rest, away;
  };
  const auto exponents =
      GENERATE(values<Exponents>({{0, 0, 4}, {0, 12, 4}, {0, -20, 20}, {40, 30, 44}, {-40, -41, -30}, {10, 0, 30}}));
  const double size = exponents.size, rest = exponents.rest, away = exponents.away;
  CAPTURE(size, rest, away);
  tools::Random random(static_cast<uint64_t>(100 + size + 3 * rest + 7 * away));
  Scene scene, truth;
  std::deque<OnDevice> buffers;
  std::vector<DeformedMesh> deformed;
  for (uint32_t i = 0; i < 60; ++i) {
    const tools::MeshData there = test::oddMesh(random, i, size), resting = test::oddMesh(random, 0, rest);
    truth.addMesh(there.positions, there.indices);
    const MeshId id = scene.addMesh(resting.positions, resting.indices);
    buffers.push_back(bufferOf(there.positions));
    deformed.push_back({id, {.buffer = buffers.back().get()}});
  }
  const std::array<double, 3> centre = random.inCube(std::exp2(away));
  // In doubles. Objects and sensors stand where the scene has them.
  const auto poseOf = [&](uint32_t i) {
    Transform pose = random.affine(centre);
    for (size_t k = 0; k < 12; ++k) {
      if (k % 4 == 3) pose.m[k] += std::exp2(size + 3) * random.uniform(-1, 1);
      // Some are nearly flat, and some have small entries.
      if (k % 4 == 2 && i % 5 == 1) pose.m[k] *= 0x1p-20;
      if (k % 4 != 3 && i % 7 == 1) pose.m[k] *= random.oneIn(3) ? 0x1p-90 : 1;
    }
    return pose;
  };
  for (uint32_t i = 0; i < 300; ++i) {
    const Object object{i % 60, poseOf(i), ~0u};
    if (!validate(object.worldFromMesh).empty()) continue;
    scene.addObject(object);
    truth.addObject(object);
  }
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 300; ++i) {
    Query query{.mesh = i % 60, .worldFromMesh = poseOf(i), .direction = random.direction()};
    query.distance = std::exp2(size + random.uniform(-3, 60));
    if (random.oneIn(8)) query.distance = 0;
    query.anyHit = random.oneIn(3);
    if (random.oneIn(4)) {
      query.ignoreLeaving = true;
      if (random.oneIn(2)) query.slack = std::exp2(size - 4);
    } else if (random.oneIn(4)) {
      query.clearance = std::exp2(size - 4);
      if (random.oneIn(2)) query.tolerance = std::exp2(size - 30);
    }
    if (random.oneIn(4)) {
      query.motion = query.direction;
      for (double& x : *query.motion) x *= query.distance;
      query.direction = {};
      query.distance = 0;
    }
    if (validate(query, scene).empty()) queries.push_back(query);
  }
  const OnDevicePlaces places(scene, deformed, queries);
  const Scene::Impl& impl = truth.impl();
  GpuScene copyOfTruth(test::device().impl());
  const test::Encoded known = test::encodedBy(copyOfTruth, impl, statedFor(truth, queries));
  std::vector<Mesh> meshes;
  for (MeshId id = 0; id < 60; ++id) {
    CAPTURE(id);
    meshes.push_back(asDescribed(impl.meshes[id], places.records[id]));
    const Box& box = places.boxes.at(id);
    for (int k = 0; k < 3; ++k) {
      CHECK(box.lo[k] == impl.meshes[id].box.lo[k] + impl.meshes[id].origin[k]);
      CHECK(box.hi[k] == impl.meshes[id].box.hi[k] + impl.meshes[id].origin[k]);
    }
  }
  test::BoundsUsed used;
  size_t objectsInRange = 0, sensorsInRange = 0, refused = 0;
  for (ObjectId id = 0; id < impl.objects.size(); ++id) {
    CAPTURE(id);
    const Object& object = truth.object(id);
    const gpu::Placement& placement = places.placements[id];
    CHECK(placement.mesh == object.mesh);
    CHECK(placement.root == places.copy.record(object.mesh).firstNode);
    if (!isInRange(placement)) continue;
    ++objectsInRange;
    test::checkPlacement(meshes[object.mesh], object.worldFromMesh, placement, used);
  }
  for (uint32_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    CAPTURE(i, query.mesh, query.distance, query.clearance, query.ignoreLeaving, query.anyHit);
    if (places.states[i].flags != 0) {
      CHECK(places.states[i].flags == gpu::kSearchOutOfRange);
      refused += known.states[i].flags == 0 ? 1 : 0;
      continue;
    }
    REQUIRE(known.states[i].flags == 0);
    ++sensorsInRange;
    const gpu::Sensor &sensor = places.sensors[i], &encoded = known.sensors[i];
    const gpu::Sweep &sweep = places.sweeps[i], &encodedSweep = known.sweeps[i];
    test::checkPlacement(meshes[query.mesh], query.worldFromMesh, sensor.placement, used);
    CHECK(sensor.scale * sensor.unscale == 1);
    CHECK(sweep.scale == sensor.scale);
    const double ratio = double{sensor.scale} / encoded.scale;
    CHECK((ratio == 1 || ratio == 0.5 || ratio == 2));
    const Translation motion = Course(query, impl).past();
    const double way = motion.wayUntil(motion.end) * sensor.scale, clipped = std::min(way, 0x1p42);
    const auto checkScaled = [&](float found, float expected) {
      CHECK(double{found} == Approx(ratio * expected).epsilon(2e-6));
    };
    CHECK((sensor.distance >= clipped && sensor.distance <= 1.00001 * clipped));
    CHECK(double{sweep.start} == Approx(clipped).epsilon(2e-6));
    checkScaled(sensor.clearance, encoded.clearance);
    if (query.anyHit) CHECK(double{sensor.stopBefore} == Approx(clipped).epsilon(2e-6));
    if (!query.anyHit) CHECK(sensor.stopBefore == -1);
    CHECK(sensor.slackShare == encoded.slackShare);
    CHECK((sweep.start <= way || !motion.isStep));
    CHECK((sensor.stopBefore <= way));
    if (way > 0) CHECK(sweep.stepPerUnit * way <= (motion.isStep ? 1 : 0));
    if (way > 0) CHECK(double{sweep.stepPerUnit} * ratio == Approx(encodedSweep.stepPerUnit).epsilon(1e-5));
    CHECK(sensor.clearance >= query.clearance * sensor.scale);
    if (query.clearance > 0) {
      CHECK(sensor.tolerance >= cpu::toleranceOf(query, impl.meshes[query.mesh]) * sensor.scale);
      CHECK(sensor.tolerance <= 1.001 * query.tolerance.value_or(1e38) * sensor.scale);
    }
    if (query.slack) CHECK(sensor.placement.error >= 2 * *query.slack);
    if (query.ignoreLeaving && test::device().doubles())
      CHECK(sweep.magnitude == Approx(encodedSweep.magnitude).epsilon(1e-6));
    CHECK(std::bit_cast<float>(places.states[i].hi) == sensor.distance);
    const Box box = boxOf(impl.meshes[query.mesh], query.worldFromMesh.m);
    const double room = query.clearance + (query.ignoreLeaving ? 2 * query.slack.value_or(0) : 0);
    for (int k = 0; k < 3; ++k) {
      using Real = long double;
      const Real middle = Real(scene.impl().objectTree().anchor()[k]) + sensor.centre[k];
      CHECK(middle + sensor.halfExtent[k] >= Real(box.hi[k]) + room);
      CHECK(middle - sensor.halfExtent[k] <= Real(box.lo[k]) - room);
    }
  }
  CHECK(objectsInRange > 150);
  CHECK(sensorsInRange > 150);
  CHECK(refused < 5);
}
