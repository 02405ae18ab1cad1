// Meshes that a host deforms without bounds: how the device describes and places them, with every option of a query,
// and what it refuses.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cpu/clearance.h"
#include "embed/host_geometry.h"
#include "embed/host_workload.h"
#include "embed/renderer.h"
#include "gpu/barrier.h"
#include "radar/cpu_sweeper.h"
#include "support/buffer_words.h"
#include "support/exact_placement.h"
#include "workloads/hard_cases.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::append;
using test::execute;
using test::HostWorkload;
using test::kRoom;
using test::OnDevice;
using test::sameBits;

OnDevice bufferOf(std::span<const float> positions) {
  std::vector<std::byte> bytes(positions.size_bytes());
  std::memcpy(bytes.data(), positions.data(), bytes.size());
  return OnDevice(bytes);
}

/// What the device writes for queries of the scene in which a host deforms all meshes.
struct OnDevicePlaces {
  OnDevicePlaces(const Scene& scene, std::span<const DeformedMesh> meshes, std::span<const Query> queries)
      : copy(test::device().impl()) {
    const Device::Impl& device = test::device().impl();
    const Scene::Impl& impl = scene.impl();
    ContactPass search(device, copy, {std::shared_ptr<void>(), &device.shared<ContactKernels>()}, {});
    HostGeometryPass geometry(device, copy);
    geometry.stage({.meshes = meshes}, impl);
    SensorBatch batch;
    std::vector<gpu::DeformedSensor> sensorsOfThem;
    std::vector<Result> known;
    for (const Query& query : queries) {
      REQUIRE(addSensor(batch, query, batch.count(), impl, impl.objectTree()) == Planned::added);
      sensorsOfThem.push_back(deformedSensor(batch.count() - 1, query, motionPast(query, impl)));
      known.emplace_back();
    }
    geometry.stageSensors(sensorsOfThem, impl);
    copy.willOverwrite(geometry.overwritten());
    search.stage(batch, known, impl);
    gpu::Submission submission(device, false);
    const gpu::Commands commands = submission.begin();
    search.recordUpload(commands, [](const char*) {});
    geometry.record(commands, impl);
    geometry.recordReach(commands, search);
    gpu::computeWriteToCopy(commands);
    geometry.recordReadback(commands);
    gpu::writtenToHost(commands);
    submission.submitAndWait();
    const ContactPass::Encoded encoded = search.encoded();
    sensors = test::elementsOf(encoded.sensors, 0, queries.size());
    sweeps = test::elementsOf(encoded.sweeps, 0, queries.size());
    states = test::elementsOf(encoded.states, 0, queries.size());
    records = test::elementsOf(copy.buffers().meshes, 0, impl.meshes.size());
    placements = test::elementsOf(copy.buffers().placements, 0, impl.objects.size());
    boxes = geometry.unboundedBoxes();
  }
  GpuScene copy;
  std::vector<gpu::Sensor> sensors;
  std::vector<gpu::Sweep> sweeps;
  std::vector<gpu::SearchState> states;
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

/// Meshes near their origins and far from them, flat ones, lines and points, too. `size`: the exponent.
tools::MeshData randomMesh(tools::Random& random, uint32_t number, double size) {
  const double extent = std::exp2(size + random.uniform(-3, 3)),
               baked = number % 2 == 0 ? 0 : extent * std::exp2(random.uniform(-4, 12));
  const std::array<double, 3> middle = random.inCube(baked);
  tools::MeshData mesh{.positions = {}, .indices = {0, 1, 2, 3, 4, 5}};
  for (size_t v = 0; v < 18; ++v) {
    const bool isFlat = (number % 5 == 3 && v % 3 == 2) || (number % 15 == 8 && v % 3 != 0) || number % 30 == 19;
    mesh.positions.push_back(static_cast<float>(middle[v % 3] + (isFlat ? 0 : random.uniform(-extent, extent))));
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
    const tools::MeshData there = randomMesh(random, i, size), resting = randomMesh(random, 0, rest);
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
    const bool wasEncoded = [&] {
      SensorBatch batch;
      return addSensor(batch, query, 0, scene.impl(), scene.impl().objectTree()) == Planned::added;
    }();
    if (validate(query, scene).empty() && wasEncoded) queries.push_back(query);
  }
  const OnDevicePlaces places(scene, deformed, queries);
  const Scene::Impl& impl = truth.impl();
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
    SensorBatch batch;
    const bool isEncoded = addSensor(batch, query, 0, impl, impl.objectTree()) == Planned::added;
    if (places.states[i].flags != 0) {
      CHECK(places.states[i].flags == gpu::kSearchOutOfRange);
      refused += isEncoded ? 1 : 0;
      continue;
    }
    REQUIRE(isEncoded);
    ++sensorsInRange;
    const gpu::Sensor &sensor = places.sensors[i], &encoded = batch.sensors[0];
    const gpu::Sweep &sweep = places.sweeps[i], &encodedSweep = batch.sweeps[0];
    test::checkPlacement(meshes[query.mesh], query.worldFromMesh, sensor.placement, used);
    CHECK(sensor.scale * sensor.unscale == 1);
    CHECK(sweep.scale == sensor.scale);
    const double ratio = double{sensor.scale} / encoded.scale;
    CHECK((ratio == 1 || ratio == 0.5 || ratio == 2));
    const Motion motion = motionPast(query, impl);
    const double way = motion.wayUntil(motion.distance) * sensor.scale, clipped = std::min(way, 0x1p42);
    const auto checkScaled = [&](float found, float expected) {
      CHECK(double{found} == Approx(ratio * expected).epsilon(2e-6));
    };
    CHECK((sensor.distance >= clipped && sensor.distance <= 1.00001 * clipped));
    CHECK(double{sweep.start} == Approx(clipped).epsilon(2e-6));
    checkScaled(sensor.frame[3], encoded.frame[3]);
    if (query.anyHit) CHECK(double{sensor.stopBefore} == Approx(clipped).epsilon(2e-6));
    if (!query.anyHit) CHECK(sensor.stopBefore == -1);
    CHECK(sensor.frame[7] == encoded.frame[7]);
    CHECK((sweep.start <= way || !motion.isStep));
    CHECK((sensor.stopBefore <= way));
    if (way > 0) CHECK(sweep.stepPerUnit * way <= (motion.isStep ? 1 : 0));
    if (way > 0) CHECK(double{sweep.stepPerUnit} * ratio == Approx(encodedSweep.stepPerUnit).epsilon(1e-5));
    CHECK(sensor.frame[3] >= query.clearance * sensor.scale);
    if (query.clearance > 0) {
      CHECK(sensor.frame[11] >= cpu::toleranceOf(query, impl.meshes[query.mesh]) * sensor.scale);
      CHECK(sensor.frame[11] <= 1.001 * query.tolerance.value_or(1e38) * sensor.scale);
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
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("lists, steps, clearances and contacts at rest are those of the vertices that a host deforms without bounds",
          "[subgroups]") {
  Scene truth, scene;
  Recorder recorder(
      test::device(), scene,
      {.queries = 24, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 18, .searches = 8192});
  CpuSweeper reference(truth);
  tools::Random random(6);
  size_t answers = 0, hits = 0, listed = 0, refused = 0;
  uint32_t number = 0;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    const uint32_t seed = 400 + number++;
    tools::Workload workload = tools::hardScene(family, seed, 0, 24, tools::Company::mixed);
    const HostWorkload host(workload, seed, scene, false);
    tools::replaceBy(workload, 0, truth);
    std::vector<Query> queries = test::queriesOf(workload);
    const bool moves = number % 3 == 0;
    for (ObjectId id = 0; moves && id < workload.objectCount(0); ++id) {
      const std::array<double, 3> motion = random.inCube(2);
      truth.setMotion(id, motion);
      scene.setMotion(id, motion);
    }
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].anyHit = i % 7 == 2;
      const bool isPlain = !moves && i % 4 != 0;
      if (!isPlain) tools::takeStep(queries[i]);
      if (i % 3 == 0 && !queries[i].anyHit) queries[i].hits = i % 2 == 0 ? kAllHits : 2;
      if (isPlain && i % 3 != 0 && !queries[i].ignoreLeaving && !queries[i].anyHit) {
        queries[i].clearance = std::exp2(random.uniform(-10, -2));
        if (random.oneIn(2)) queries[i].tolerance = std::exp2(random.uniform(-20, -4));
      }
      queries[i].skipOverlapping = false;
    }
    const test::Answers got = execute(test::device(), recorder, queries, host.geometry());
    const std::vector<Result> expected = reference.run(queries);
    for (uint32_t i = 0; i < queries.size(); ++i) {
      CAPTURE(family.name, seed, i, moves, queries[i].hits, queries[i].clearance, got.results[i].flags);
      ++answers;
      Result wanted = expected[i];
      wanted.tier = Tier::contact;
      if (got.results[i].status == Status::invalid || got.results[i].flags == kFlagUnresolved) {
        // Without a tree for the deformed mesh, or as a clearance that doubles leave open.
        CHECK((got.results[i].flags & (kFlagUnresolved | kFlagCandidates | kFlagRounds)) != 0);
        ++refused;
        continue;
      }
      hits += wanted.status == Status::hit;
      if (queries[i].anyHit || got.results[i].object != wanted.object) {
        CHECK(got.results[i].status == wanted.status);
        CHECK_FALSE(wanted.lo > got.results[i].hi);
        if (!queries[i].anyHit) CHECK_FALSE(got.results[i].lo > wanted.hi);
      } else {
        CHECK(sameBits(got.results[i], wanted));
      }
      if (queries[i].hits == 1) continue;
      const std::span<const Result> found = got.lists.hitsOf(i), others = reference.lists().hitsOf(i);
      REQUIRE(found.size() == others.size());
      for (size_t k = 0; k < found.size(); ++k) {
        CHECK((found[k].lo <= others[k].hi && others[k].lo <= found[k].hi));
      }
      listed += found.size();
    }
  }
  CHECK(answers > 500);
  CHECK(hits > answers / 5);
  CHECK(listed > 300);
  CHECK(refused < answers / 20);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("meshes that a recording no longer deforms, and their objects, are the scene's again") {
  tools::Random random(12);
  Scene scene, truth;
  const tools::MeshData torus = tools::makeTorus(3, 1, 12, 8), box = tools::makeBox({1, 1, 1});
  std::vector<MeshId> meshes;
  for (int i = 0; i < 3; ++i) {
    meshes.push_back(scene.addMesh(torus.positions, torus.indices));
    truth.addMesh(torus.positions, torus.indices);
  }
  const MeshId sensor = scene.addMesh(box.positions, box.indices);
  truth.addMesh(box.positions, box.indices);
  std::vector<ObjectId> objects;
  for (uint32_t i = 0; i < 60; ++i) {
    Object object{meshes[i % 3], random.affine(random.inCube(30)), ~0u};
    for (double& x : object.worldFromMesh.m) x = static_cast<float>(x);
    objects.push_back(scene.addObject(object));
    truth.addObject(object);
  }
  SceneCopy copy(test::device(), scene);
  Recorder first(copy, kRoom), second(copy, kRoom);
  size_t hits = 0;
  for (int frame = 0; frame < 12; ++frame) {
    CAPTURE(frame);
    // Which meshes are deformed, by how much, and which objects are moved, changes from frame to frame.
    std::deque<OnDevice> buffers;
    std::vector<DeformedMesh> deformed;
    for (uint32_t i = 0; i < 3; ++i) {
      std::vector<float> positions = torus.positions;
      if (random.oneIn(2)) {
        const double scale = std::exp2(random.uniform(-6, 3));
        const tools::Vec3 at = random.inCube(random.oneIn(2) ? 0 : 100);
        for (size_t k = 0; k < positions.size(); ++k) {
          positions[k] = static_cast<float>(scale * positions[k] + 0.1 * random.uniform(-1, 1) + at[k % 3]);
        }
        buffers.push_back(bufferOf(positions));
        deformed.push_back({meshes[i], {.buffer = buffers.back().get()}});
      }
      truth.setPositions(meshes[i], positions);
    }
    std::vector<std::byte> bytes;
    std::vector<ObjectId> moved;
    for (const ObjectId id : objects) {
      Transform pose = scene.object(id).worldFromMesh;
      if (frame % 3 != 0 && random.oneIn(3)) {
        for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] = static_cast<float>(random.uniform(-30, 30));
        for (const double x : pose.m) append<float>(bytes, {static_cast<float>(x)});
        moved.push_back(id);
      }
      truth.setTransform(id, pose);
    }
    const OnDevice transforms(bytes.empty() ? std::vector<std::byte>(48) : bytes);
    const MovedObjects group{.transforms = transforms.get(), .objects = moved};
    HostGeometry geometry{.meshes = deformed};
    if (!moved.empty()) geometry.objects = {&group, 1};
    std::vector<Query> queries;
    for (uint32_t i = 0; i < 40; ++i) {
      Query query{.mesh = i % 3 == 0 ? sensor : meshes[i % 3], .direction = random.direction(), .distance = 60};
      query.worldFromMesh = random.affine(random.inCube(20));
      queries.push_back(query);
    }
    Recorder& recorder = frame % 2 == 0 ? first : second;
    const std::vector<Result> got = execute(recorder, queries, geometry), expected = CpuSweeper(truth).run(queries);
    for (size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i, got[i].flags, got[i].t, expected[i].t, got[i].object, expected[i].object);
      Result wanted = expected[i];
      wanted.tier = got[i].tier;
      CHECK(sameBits(got[i], wanted));
      hits += wanted.status == Status::hit;
    }
    if (frame == 7) {
      // Not executed.
      gpu::Submission submission(test::device().impl(), false);
      first.record(submission.begin(), queries, geometry);
      first.reset();
    }
  }
  CHECK(hits > 100);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("of a mesh without bounds only finite vertices are taken, and those of triangles decide how large it is") {
  Scene scene;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // Vertices 2, 4 and 7 of the host's buffer are a triangle.
  const auto positions = [](float z, float other, float last) {
    std::vector<float> all(24, other);
    const float corners[] = {-1, -1, z, 1, -1, z, 0, 1, last};
    for (size_t i = 0; i < 9; ++i) all[3 * std::array<size_t, 3>{2, 4, 7}[i / 3] + i % 3] = corners[i];
    return all;
  };
  std::vector<std::byte> corners;
  append<uint16_t>(corners, {4, 2, 7});
  const OnDevice rest = bufferOf(positions(5, 1000, 5)), indices(corners);
  const MeshId wall = addMesh(scene, test::device(),
                              {.positions = {.buffer = rest.get()},
                               .vertexCount = 8,
                               .indices = indices.get(),
                               .indexType = VK_INDEX_TYPE_UINT16,
                               .indexCount = 3});
  scene.addObject({.mesh = wall});
  // Of this one, vertex 3 belongs to no triangle.
  const float quad[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 7, 7, 7};
  const uint32_t triangle[] = {0, 1, 2};
  const MeshId own = scene.addMesh(quad, triangle);
  scene.addObject({.mesh = own, .worldFromMesh = {{1, 0, 0, 40, 0, 1, 0, 0, 0, 0, 1, 6}}});
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  std::vector<Query> queries(
      2, {.mesh = scene.addMesh(box.positions, box.indices), .direction = {0, 0.001, 1}, .distance = 20});
  queries[1].worldFromMesh.m[3] = 40;
  Recorder recorder(test::device(), scene, kRoom);
  const auto answersAt = [&](const OnDevice& shared, const OnDevice& second) {
    const DeformedMesh deformed[] = {{wall, {.buffer = shared.get()}}, {own, {.buffer = second.get()}}};
    return execute(recorder, queries, {.meshes = deformed});
  };
  const auto ownAt = [&](float z, float unused) {
    return bufferOf(std::vector<float>{-1, -1, z, 1, -1, z, 0, 1, z, unused, unused, unused});
  };
  const auto expectHits = [&](float other, float unused) {
    const std::vector<Result> read = answersAt(bufferOf(positions(3, other, 3)), ownAt(1, unused));
    CHECK(read[0].t == Approx(2.5));
    CHECK(read[1].t == Approx(6.5));
    CHECK(recorder.boundsViolation().empty());
  };
  expectHits(0, 0);
  expectHits(nan, 1e35f);
  const auto expectRefused = [&](const std::vector<Result>& read, const std::string& why) {
    for (const Result& result : read) CHECK((result.status == Status::invalid && result.flags == kFlagBounds));
    CHECK(recorder.boundsViolation() == why);
  };
  expectRefused(answersAt(bufferOf(positions(3, 0, nan)), ownAt(1, 0)),
                "mesh 0: vertex 7 is not finite, or exceeds 2^120");
  expectRefused(answersAt(bufferOf(positions(3, 0, 3)), ownAt(1, nan)),
                "mesh 1: vertex 3 is not finite, or exceeds 2^120");
  expectRefused(answersAt(bufferOf(positions(3, 0, -3e38f)), ownAt(1, 0)),
                "mesh 0: vertex 7 is not finite, or exceeds 2^120");
  expectHits(0, 0);
  // Too large to be placed: the object leaves what floats can hold.
  expectRefused(answersAt(bufferOf(positions(1e30f, 0, 1e30f)), ownAt(1, 0)),
                "object 0: its transform is not finite, or floats cannot hold its box");
  CHECK(test::takeValidationMessages().empty());
}
