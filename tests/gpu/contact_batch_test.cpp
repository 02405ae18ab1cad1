// In mode contact, batches do not change answers, and large meshes and many simultaneous contacts are handled.
#include <algorithm>
#include <cmath>

#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

struct LoadedWorkload {
  explicit LoadedWorkload(tools::Workload w) : workload(std::move(w)), player(workload) {
    player.show(0);
    queries = tools::queriesOf(workload.queries);
  }
  tools::Workload workload;
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

void checkSame(const std::vector<Result>& a, const std::vector<Result>& b) {
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    if (test::sameBits(a[i], b[i])) continue;
    CAPTURE(i, a[i].t, b[i].t, a[i].lo, b[i].lo, a[i].hi, b[i].hi, a[i].object, b[i].object, a[i].triB, b[i].triB,
            a[i].triA, b[i].triA, uint32_t(a[i].tier), uint32_t(b[i].tier));
    CHECK(test::sameBits(a[i], b[i]));
  }
}

// SweeperOptions::cpuBatch: all queries on the device, all on the CPU.
constexpr uint32_t kOnDevice = 0, kOnCpu = kNone - 1;

Transform at(double x, double y, double z) {
  return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}};
}

MeshId add(Scene& scene, const tools::MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

}  // namespace

TEST_CASE(
    "in mode contact a batch of any size gives the same bits as one query at a time, on the device and on the CPU") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 1234}));
  const uint32_t cpuBatch = GENERATE(kOnDevice, 500u, kNone);
  CAPTURE(cpuBatch);
  Sweeper sweeper(test::device(), loaded.player.scene(), {.cpuBatch = cpuBatch});
  std::vector<Result> single;
  for (const Query& query : loaded.queries) single.push_back(sweeper.run({&query, 1}).results[0]);
  CHECK(std::count_if(single.begin(), single.end(), [](const Result& r) { return r.status == Status::hit; }) > 100);
  for (size_t size : {63, 64, 65, 1234}) {
    CAPTURE(size);
    const Answers answers = sweeper.run(std::span(loaded.queries).first(size));
    checkSame(answers.results, {single.begin(), single.begin() + size});
    if (size < cpuBatch && cpuBatch != kNone) CHECK(answers.stats.cpuQueries == size);
    // Without doubles, the device may leave some queries unresolved.
    if (size >= cpuBatch && test::device().doubles()) CHECK(answers.stats.cpuQueries == 0);
  }
  Sweeper processor(test::device(), loaded.player.scene(), {.cpuBatch = kOnCpu});
  const Answers answers = processor.run(loaded.queries);
  checkSame(answers.results, single);
  CHECK(answers.stats.cpuQueries == loaded.queries.size());
  CHECK(answers.stats.submissions == 0);
}

TEST_CASE("in mode contact queries over soups have the same bits alone, in a batch, in reverse order and on the CPU",
          "[subgroups]") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Soups{.sensors = 130, .triangles = 100, .seed = 4}));
  Sweeper sweeper(test::device(), loaded.player.scene(), {.cpuBatch = kOnDevice});
  std::vector<Result> single;
  for (const Query& query : loaded.queries) single.push_back(sweeper.run({&query, 1}).results[0]);
  checkSame(sweeper.run(loaded.queries).results, single);
  Sweeper other(test::device(), loaded.player.scene(), {.cpuBatch = kOnCpu});
  std::reverse(loaded.queries.begin(), loaded.queries.end());
  std::vector<Result> backward = other.run(loaded.queries).results;
  std::reverse(backward.begin(), backward.end());
  checkSame(backward, single);
}

TEST_CASE("batches of both modes by turns have the same bits as those of one mode") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 130}));
  for (Query& query : loaded.queries) query.resolution = 32;
  const auto fresh = [&](Mode mode) {
    return Sweeper(test::device(), loaded.player.scene(), {.cpuBatch = kOnDevice}).run(loaded.queries, mode).results;
  };
  const std::vector<Result> precise = fresh(Mode::contact), coarse = fresh(Mode::sampled);
  Sweeper sweeper(test::device(), loaded.player.scene(), {.cpuBatch = kOnDevice});
  for (int round = 0; round < 2; ++round) {
    checkSame(sweeper.run(loaded.queries, Mode::sampled).results, coarse);
    checkSame(sweeper.run(loaded.queries).results, precise);
  }
}

TEST_CASE("mode contact handles a mesh of 160,000 triangles as an object and as a sensor") {
  Scene scene;
  const MeshId sphere = add(scene, tools::makeUvSphere(200, 400)), cube = add(scene, tools::makeBox({0.5, 0.5, 0.5}));
  REQUIRE(scene.mesh(sphere).triangleCount() > 159'000);
  scene.addObject({sphere, {}, ~0u});
  scene.addObject({cube, at(0.1, 0.2, 20), ~0u});
  Sweeper sweeper(test::device(), scene, {.cpuBatch = GENERATE(kOnDevice, kOnCpu)});
  // The ball's half height above the box's corner that is nearest to its axis, at an offset of (0.1, 0.05).
  const double reach = std::sqrt(1 - 0.1 * 0.1 - 0.05 * 0.05);
  const auto check = [&](const Query& query, ObjectId object, double least, double most) {
    const Result result = sweeper.run({&query, 1}).results[0];
    CHECK(result.status == Status::hit);
    CHECK(result.tier == Tier::contact);
    CHECK(result.object == object);
    CHECK(result.t >= least);
    CHECK(result.t <= most);
    CHECK(result.hi - result.lo <= 1e-9 * 10);
  };
  // The box covers the ball's pole, which is exactly 1 from the centre.
  check({.mesh = cube, .worldFromMesh = at(0.1, 0.2, -5), .direction = {0, 0, 1}, .distance = 10}, 0, 3.75, 3.7500001);
  check({.mesh = cube, .worldFromMesh = at(5, 0.3, 0.25), .direction = {-3, 0, 0}, .distance = 10}, 0, 3.75, 3.76);
  check({.mesh = sphere, .worldFromMesh = at(0, 0, 10), .direction = {0, 0, 1}, .distance = 50}, 1, 8.75, 8.7500001);
  check({.mesh = sphere, .worldFromMesh = at(0.45, 0.5, 10), .direction = {0, 0, 1}, .distance = 50}, 1, 8.75,
        9.75 - reach + 0.001);
  check({.mesh = sphere, .worldFromMesh = at(-0.5, 0.25, -7), .direction = {0, 0, 0.1}, .distance = 50}, 0, 5,
        7 - 2 * 0.9);
  const Query within{.mesh = sphere,
                     .worldFromMesh = {{0.5, 0, 0, 0.1, 0, 0.5, 0, 0, 0, 0, 0.5, 0}},
                     .direction = {1, 0, 0},
                     .distance = 0.2};
  CHECK(sweeper.run({&within, 1}).results[0].status == Status::clear);
}
