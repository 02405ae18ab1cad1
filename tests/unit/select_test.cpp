// Selects the objects in a swept prism while the scene changes.
#include <algorithm>

#include "math/frame.h"
#include "sampled/select.h"
#include "support/catch.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

bool reachesInto(const Prism& prism, const Scene& scene, ObjectId id) {
  const Object& object = scene.object(id);
  const MeshView mesh = scene.mesh(object.mesh);
  for (const uint32_t vertex : mesh.indices) {
    std::array<double, 3> p = transformPoint(object.worldFromMesh, &mesh.positions[3 * size_t{vertex}]);
    for (int k = 0; k < 3; ++k) p[k] -= prism.origin[k];
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const double at = dot(prism.axes[k], p);
      inside = inside && at >= prism.box.lo[k] && at <= prism.box.hi[k];
    }
    if (inside) return true;
  }
  return false;
}

std::vector<ObjectId> selected(const Scene& scene, const Prism& prism) {
  std::vector<ObjectId> ids;
  selectObjects(scene.impl(), prism, ids);
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace

TEST_CASE("every object with a vertex in the prism is selected once, while the scene changes") {
  tools::Random random(11);
  const double away = GENERATE(0.0, 1e9);
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 2, 3});
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  std::vector<ObjectId> objects;
  const auto anywhere = [&] { return random.inBox({away - 20, away - 20, -20}, {away + 20, away + 20, 20}); };
  const auto randomPose = [&] { return tools::makePose(random.rotation(), {0.3, 0.5, 1.0}, anywhere()); };
  size_t named = 0, inside = 0;
  for (int round = 0; round < 60; ++round) {
    // Adds some objects, moves some and removes some.
    for (int i = 0; i < 10; ++i) objects.push_back(scene.addObject({mesh, randomPose(), ~0u}));
    for (int i = 0; i < 5; ++i) scene.setTransform(objects[random.below(uint32_t(objects.size()))], randomPose());
    if (round % 3 == 2) {
      scene.removeObject(objects.back());
      objects.pop_back();
    }
    const Prism prism{anywhere(), axesAlong(random.direction()), {{-2, -1, 0}, {2, 1, random.uniform(0, 30)}}};
    const std::vector<ObjectId> ids = selected(scene, prism);
    CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
    CHECK(std::includes(objects.begin(), objects.end(), ids.begin(), ids.end()));
    named += ids.size();
    for (const ObjectId id : objects) {
      const bool reaches = reachesInto(prism, scene, id);
      inside += reaches;
      if (reaches) CHECK(std::binary_search(ids.begin(), ids.end(), id));
    }
  }
  CHECK(inside > 50);
  CHECK(named < 4 * inside);
}

TEST_CASE("objects are also selected if one of them is too far away for the tree") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  const auto at = [](double x) { return Transform{{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}}; };
  const ObjectId near = scene.addObject({mesh, at(0), ~0u});
  scene.addObject({mesh, at(50), ~0u});
  const ObjectId remote = scene.addObject({mesh, at(1e30), ~0u});
  const Prism prism{{0, 0, 0}, axesAlong({0, 0, 1}), {{-1, -1, -1}, {1, 1, 1}}};
  CHECK(selected(scene, prism) == std::vector<ObjectId>{near});
  scene.removeObject(remote);
  CHECK(selected(scene, prism) == std::vector<ObjectId>{near});
}
