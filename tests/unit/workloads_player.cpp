#include "support/catch.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::tools;

namespace {

Instance at(uint32_t mesh, double x) {
  Instance instance{mesh, {}};
  instance.worldFromMesh.m[3] = x;
  return instance;
}

void requireShows(const Scene& scene, const std::vector<Instance>& instances, const std::vector<uint32_t>& masks) {
  REQUIRE(scene.objectLimit() >= instances.size());
  for (uint32_t id = 0; id < scene.objectLimit(); ++id) REQUIRE(scene.hasObject(id) == (id < instances.size()));
  for (uint32_t id = 0; id < instances.size(); ++id) {
    CHECK(scene.object(id).mesh == instances[id].mesh);
    CHECK(scene.object(id).worldFromMesh == instances[id].worldFromMesh);
    CHECK(scene.object(id).mask == masks[id]);
  }
}

}  // namespace

TEST_CASE("a player shows scenes in any order, with object ids that equal the instances' positions") {
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makePlate(2, 2, 0.1)};
  workload.scenes = {
      {"still", {}, {at(0, 1), at(1, 2)}, {}},     {"more", 0, {at(0, 3), at(1, 4)}, {}},
      {"moved", 0, {at(0, 5), at(1, 6)}, {}},      {"other meshes", 0, {at(1, 5), at(0, 6), at(0, 7)}, {}},
      {"masked", 0, {at(1, 5)}, {{0, 6}, {2, 9}}}, {"alone", {}, {at(1, 8)}, {}}};
  const std::vector<std::vector<Instance>> expected{{at(0, 1), at(1, 2)},
                                                    {at(0, 1), at(1, 2), at(0, 3), at(1, 4)},
                                                    {at(0, 1), at(1, 2), at(0, 5), at(1, 6)},
                                                    {at(0, 1), at(1, 2), at(1, 5), at(0, 6), at(0, 7)},
                                                    {at(0, 1), at(1, 2), at(1, 5)},
                                                    {at(1, 8)}};
  ScenePlayer player(workload);
  for (uint32_t scene : {0, 1, 2, 3, 4, 1, 4, 2, 5, 3, 0, 5, 5, 4}) {
    CAPTURE(scene);
    player.show(scene);
    std::vector<uint32_t> masks(expected[scene].size(), ~0u);
    if (scene == 4) masks = {6, ~0u, 9};
    requireShows(player.scene(), expected[scene], masks);
  }
}

TEST_CASE("queries with the same scene and batch number form one batch, wherever they are in the list") {
  Workload workload;
  workload.scenes.resize(2);
  workload.queries.resize(5);
  workload.queries[0].batch = 7;
  workload.queries[1].scene = 1;
  workload.queries[2].batch = 7;
  workload.queries[3].scene = 1;
  workload.queries[3].batch = 7;
  workload.queries[4].batch = 0;
  const std::vector<Batch> batches = batchesOf(workload.queries);
  REQUIRE(batches.size() == 4);
  CHECK(batches[0].scene == 0);
  CHECK(batches[0].numbers == std::vector<uint32_t>{0, 2});
  CHECK(batches[1].scene == 1);
  CHECK(batches[1].numbers == std::vector<uint32_t>{1});
  CHECK(batches[2].numbers == std::vector<uint32_t>{3});
  CHECK(batches[3].numbers == std::vector<uint32_t>{4});
}

TEST_CASE("a player moves objects and deforms meshes only in the scenes that say so") {
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makePlate(2, 2, 0.1)};
  std::vector<float> stretched = workload.meshes[0].positions;
  for (float& c : stretched) c *= 3;
  workload.scenes = {{"still", {}, {at(0, 1), at(1, 2)}},
                     {"moves", 0, {at(0, 3)}, {}, {{1, {0, 0, 2}}, {2, {1, 0, 0}}}},
                     {"deformed", 0, {}, {}, {}, {{0, stretched}}}};
  ScenePlayer player(workload);
  for (uint32_t scene : {0, 1, 2, 1, 0, 2, 2, 0}) {
    CAPTURE(scene);
    player.show(scene);
    Scene again;
    replaceBy(workload, scene, again);
    for (const Scene* shown : {&player.scene(), static_cast<const Scene*>(&again)}) {
      CHECK(shown->object(1).motion[2] == (scene == 1 ? 2 : 0));
      CHECK(shown->object(0).motion == std::array<double, 3>{});
      const MeshView mesh = shown->mesh(0);
      CHECK(std::ranges::equal(mesh.positions, scene == 2 ? stretched : workload.meshes[0].positions));
    }
  }
}
