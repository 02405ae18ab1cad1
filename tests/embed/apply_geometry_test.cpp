// What a host's buffers hold is given to the scene.
#include "embed/on_device.h"
#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::append;
using test::OnDevice;
using test::sameBits;

std::vector<std::byte> bytesOf(std::span<const float> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {bytes.begin(), bytes.end()};
}

struct Town {
  Scene scene;
  MeshId mesh = kNone;
  std::vector<ObjectId> objects;
};

Town townOf(const tools::MeshData& data) {
  Town town;
  town.mesh = town.scene.addMesh(data.positions, data.indices);
  for (int i = 0; i < 40; ++i) town.objects.push_back(town.scene.addObject({.mesh = town.mesh}));
  return town;
}

}  // namespace

TEST_CASE("sweepers, pools and the CPU search the vertices and poses that a host's buffers hold") {
  tools::Random random(71);
  const tools::MeshData soup = tools::makeSoup(tools::Soup::plain, 60, random);
  Town read = townOf(soup), given = townOf(soup);
  Sweeper sweeper(test::device(), read.scene, {.cpuBatch = 0});
  Pool pool({&test::device(), 1}, read.scene, {.cpuBatch = 0});
  CpuSweeper cpu(read.scene), expecting(given.scene);
  size_t hits = 0;
  for (int step = 0; step < 6; ++step) {
    std::vector<float> positions = soup.positions, rows;
    for (float& p : positions) p += static_cast<float>(random.uniform(-0.3, 0.3));
    std::vector<Transform> poses;
    for (const ObjectId id : given.objects) {
      Transform pose = random.affine(random.inCube(8));
      for (double& entry : pose.m) entry = static_cast<float>(entry);
      rows.insert(rows.end(), pose.m.begin(), pose.m.end());
      given.scene.setTransform(id, pose);
    }
    given.scene.setPositions(given.mesh, positions);
    const OnDevice vertices(bytesOf(positions)), transforms(bytesOf(rows));
    const DeformedMesh deformed{read.mesh, {.buffer = vertices.get()}};
    const MovedObjects moved{.transforms = transforms.get(), .objects = read.objects};
    pool.edit([&] { applyGeometry(read.scene, test::device(), {.meshes = {&deformed, 1}, .objects = {&moved, 1}}); });
    std::vector<Query> queries(30);
    for (Query& query : queries) {
      query = {.mesh = read.mesh, .worldFromMesh = random.affine(random.inCube(8))};
      query.direction = random.direction();
      query.distance = random.uniform(1, 20);
    }
    std::vector<Result> expected = expecting.run(queries);
    for (Result& result : expected) result.tier = Tier::contact;
    std::vector<Result> onCpu = cpu.run(queries);
    for (Result& result : onCpu) result.tier = Tier::contact;
    for (const std::vector<Result>& found : {sweeper.run(queries), pool.submit(queries).get().results, onCpu}) {
      for (size_t i = 0; i < queries.size(); ++i) {
        CAPTURE(step, i);
        REQUIRE(sameBits(found[i], expected[i]));
      }
    }
    for (const Result& result : expected) hits += result.status == Status::hit;
  }
  CHECK(hits > 30);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a mesh of some vertices of a host's buffer takes new positions by their numbers there") {
  std::vector<std::byte> before, after, corners;
  for (int v = 0; v < 100; ++v) append<float>(before, {float(v), float(v * v), 1, /* a normal */ 9});
  for (int v = 0; v < 100; ++v) append<float>(after, {float(v), float(v * v), 2, 9});
  append<uint32_t>(corners, {70, 7, 30, 30, 7, 99});
  const OnDevice old(before), next(after), indices(corners);
  Scene scene;
  const auto add = [&](const std::optional<Bounds>& bounds) {
    return addMesh(scene, test::device(),
                   {.positions = {.buffer = old.get(), .stride = 16},
                    .vertexCount = 100,
                    .indices = indices.get(),
                    .indexCount = 6,
                    .bounds = bounds});
  };
  const MeshId used = add(std::nullopt), ranged = add(Bounds{{0, 0, 0}, {100, 10'000, 2}});
  const DeformedMesh deformed[] = {{used, {.buffer = next.get(), .stride = 16}},
                                   {ranged, {.buffer = next.get(), .stride = 16}}};
  applyGeometry(scene, test::device(), {.meshes = deformed});
  const auto positions = scene.mesh(used).positions;
  CHECK(std::vector<float>(positions.begin(), positions.end()) ==
        std::vector<float>{7, 49, 2, 30, 900, 2, 70, 4900, 2, 99, 9801, 2});
  const auto all = scene.mesh(ranged).positions;
  CHECK(all.size() == 3 * 93);
  CHECK(std::vector<float>(all.begin(), all.begin() + 6) == std::vector<float>{7, 49, 2, 8, 64, 2});
}

TEST_CASE("applyGeometry names the mesh or the object whose numbers cannot be used") {
  std::vector<std::byte> bytes;
  append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, NAN, 0, 0, 0, 0});
  const OnDevice buffer(bytes);
  Scene scene;
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<uint32_t> indices{0, 1, 2};
  const MeshId mesh = scene.addMesh(positions, indices);
  const MeshId bounded = scene.addMesh(positions, indices, Bounds{{0, 0, 0}, {1, 1, 0}});
  const ObjectId object = scene.addObject({.mesh = mesh});
  const auto refused = [&](const HostGeometry& geometry, const char* why) {
    CHECK_THROWS_WITH(applyGeometry(scene, test::device(), geometry), test::Contains(why));
  };
  const DeformedMesh unfinished{mesh, {.buffer = buffer.get()}}, unknown{7, {.buffer = buffer.get()}};
  refused({.meshes = {&unfinished, 1}}, "applyGeometry: mesh 0: setPositions: vertex 2 is not finite");
  refused({.meshes = {&unknown, 1}}, "applyGeometry: mesh 7 does not exist");
  const MovedObjects moved{.transforms = buffer.get(), .objects = {&object, 1}};
  refused({.objects = {&moved, 1}}, "setTransforms: object 0: expected 12 finite numbers");
  std::vector<std::byte> far;
  append<float>(far, {0, 0, 0, 1, 0, 0, 0, 2, 0});
  const OnDevice outside(far);
  const DeformedMesh beyond{bounded, {.buffer = outside.get()}};
  refused({.meshes = {&beyond, 1}}, "vertex 2 is outside the mesh's bounds");
  CHECK(scene.mesh(bounded).positions[7] == 1);
}
