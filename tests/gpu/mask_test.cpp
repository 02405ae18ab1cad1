// The contact tier's two ways, and the change from one to the other, give the same bits.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "support/test_device.h"
#include "sweep/sweeper.h"
#include "workloads/families.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace {

using namespace radar;

/// Answers in one way.
class Asking {
 public:
  Asking(const Scene& scene, ContactRoom room)
      : sweeper_(test::device(), scene, {}, std::make_shared<SceneCopy>(test::device().impl()), room) {}

  std::vector<Result> run(const std::vector<Query>& queries) {
    std::vector<Result> results(queries.size());
    sweeper_.begin(queries, results);
    sweeper_.finish();
    return results;
  }
  const SweepStats& stats() const { return sweeper_.stats; }

 private:
  Sweeper::Impl sweeper_;
};

std::vector<Query> queriesOf(const tools::Workload& workload) {
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::contact));
  return queries;
}

void show(Scene& scene, const tools::Workload& workload) {
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id)) scene.removeObject(id);
  }
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    if (scene.hasMesh(id)) scene.removeMesh(id);
  }
  for (const tools::MeshData& mesh : workload.meshes) scene.addMesh(mesh.positions, mesh.indices);
  for (const tools::Instance& instance : workload.scenes[0].instances) {
    scene.addObject({instance.mesh, instance.worldFromMesh, ~0u});
  }
}

void checkSame(const std::vector<Result>& a, const std::vector<Result>& b) {
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(Result)) == 0) continue;
    CAPTURE(i, uint32_t(a[i].status), uint32_t(b[i].status), a[i].t, b[i].t, a[i].object, b[i].object, a[i].triB,
            b[i].triB, a[i].triA, b[i].triA);
    CHECK(std::memcmp(&a[i], &b[i], sizeof(Result)) == 0);
  }
}

}  // namespace

TEST_CASE("direct, by the mask and with the switch, random queries of every family get the same bits") {
  // One scene whose content is exchanged, so that pipelines are made once.
  Scene scene;
  Asking direct(scene, {.way = ContactWay::direct}), masked(scene, {.way = ContactWay::masked}), cheaper(scene, {});
  for (const tools::Family family : tools::kFamilies) {
    CAPTURE(tools::nameOf(family));
    size_t contacts = 0;
    for (uint64_t seed = 51; seed < 54; ++seed) {
      CAPTURE(seed);
      const tools::Workload workload =
          tools::makeWorkload(tools::FamilyScene{.family = family, .queries = 64, .seed = seed});
      show(scene, workload);
      const std::vector<Query> queries = queriesOf(workload);
      const std::vector<Result> expected = direct.run(queries);
      for (const Result& result : expected) contacts += result.status != Status::clear;
      checkSame(masked.run(queries), expected);
      checkSame(cheaper.run(queries), expected);
    }
    CHECK(contacts >= 5);
  }
}

TEST_CASE("interlocking shapes take the switch, which leaves fewer pairs and the same bits") {
  Scene scene;
  Asking direct(scene, {.way = ContactWay::direct}), cheaper(scene, {});
  for (const tools::Interlocking kind : tools::kInterlocking) {
    CAPTURE(nameOf(kind));
    const tools::Workload workload = tools::makeWorkload(tools::InterlockingPairs{.kind = kind, .sensors = 2});
    show(scene, workload);
    std::vector<Query> queries = queriesOf(workload);
    const std::vector<Result> expected = direct.run(queries);
    checkSame(cheaper.run(queries), expected);
    // Two combs are settled along the axes of their clusters before the mask would pay.
    const bool switches = kind != tools::Interlocking::combInComb;
    CHECK((cheaper.stats().clusterPairs < direct.stats().clusterPairs) == switches);
    CHECK((cheaper.stats().pairs < direct.stats().pairs) == switches);
    for (Query& query : queries) query.decide = true;
    const std::vector<Result> decided = cheaper.run(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      CHECK((decided[i].status == Status::clear) == (expected[i].status == Status::clear));
    }
  }
}

TEST_CASE("what touches at exactly what is known to be met survives the mask") {
  // A grid of boxes that a plate meets all at the same moment; its first contact is known after the first.
  Scene scene;
  const tools::MeshData cube = tools::makeBox({1, 1, 1}), sheet = tools::makePlate(64, 64, 1);
  const MeshId box = scene.addMesh(cube.positions, cube.indices), plate = scene.addMesh(sheet.positions, sheet.indices);
  for (int y = 15; y >= 0; --y) {
    for (int x = 15; x >= 0; --x) {
      scene.addObject({box, {{1, 0, 0, 2.0 * x - 16, 0, 1, 0, 2.0 * y - 16, 0, 0, 1, 6}}, ~0u});
    }
  }
  Query query{.mesh = plate, .direction = {0, 0, 2}, .distance = 5};
  Asking masked(scene, {.way = ContactWay::masked});
  for (uint32_t least = 0; least < 3; ++least) {
    const Result result = masked.run({query})[0];
    CHECK(result.status == Status::hit);
    CHECK(result.t == 5);
    CHECK(result.object == least);
    query.exclude.push_back(least);
  }
  query.distance = std::nextafter(5, 0);
  CHECK(masked.run({query})[0].status == Status::clear);
}

TEST_CASE("what a bounded look has met bounds the search, and the answer keeps its bits") {
  const tools::Workload workload = tools::makeWorkload(tools::InterlockingPairs{.sensors = 6});
  tools::ScenePlayer player(workload);
  player.show(0);
  std::vector<Query> queries = queriesOf(workload);
  const ContactWay way = GENERATE(ContactWay::direct, ContactWay::cheaper, ContactWay::masked);
  Asking asking(player.scene(), {.way = way});
  const std::vector<Result> expected = asking.run(queries);
  const uint64_t clusterPairs = asking.stats().clusterPairs;
  for (Query& query : queries) query.tolerance = 1e-12;
  checkSame(asking.run(queries), expected);
  // Which searches ask for the mask, and are then counted under it, is a matter of what they have spent: it varies.
  if (way != ContactWay::cheaper) CHECK(asking.stats().clusterPairs < clusterPairs);
}
