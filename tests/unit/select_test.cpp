// Plans of mode sampled select the objects in the sensor's way while the scene changes.
#include <algorithm>

#include "sampled/in_frame.h"
#include "sampled/plan.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

ViewPlan planOf(const Scene& scene, const Query& query) {
  return planSampled(query, scene.impl(), 8, Drawn::inReach);
}

std::vector<ObjectId> selectedBy(const ViewPlan& plan) {
  std::vector<ObjectId> ids;
  for (const Placed& placed : plan.inReach) ids.push_back(placed.draw.object);
  return ids;
}

// Whether a vertex of the object is in the window, swept.
bool reachesInto(const ViewPlan& plan, const Scene& scene, ObjectId id) {
  const Object& object = scene.object(id);
  const MeshView mesh = scene.mesh(object.mesh);
  // The last pixels may pass the window's edge.
  const double extents[] = {plan.pixel * (plan.view.width - 1), plan.pixel * (plan.view.height - 1), plan.d};
  return std::any_of(mesh.indices.begin(), mesh.indices.end(), [&](uint32_t vertex) {
    const Vector p = minus(transformPoint(object.worldFromMesh, &mesh.positions[3 * size_t{vertex}]), plan.corner);
    for (int k = 0; k < 3; ++k) {
      if (const double at = dot(plan.axes[k], p); at < 0 || at > extents[k]) return false;
    }
    return true;
  });
}

}  // namespace

TEST_CASE("every object with a vertex in the sensor's way is selected once, while the scene changes") {
  tools::Random random(11);
  const double away = GENERATE(0.0, 1e9);
  Scene scene;
  const MeshId mesh = test::add(scene, tools::makeBox({1, 2, 3}));
  const MeshId sensor = test::add(scene, tools::makeBox({4, 2, 1}));
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
    const Query query{.mesh = sensor,
                      .worldFromMesh = tools::makePose(random.rotation(), {1, 1, 1}, anywhere()),
                      .direction = random.direction(),
                      .distance = random.uniform(0, 30)};
    const ViewPlan plan = planOf(scene, query);
    const std::vector<ObjectId> ids = selectedBy(plan);
    CHECK(std::is_sorted(ids.begin(), ids.end()));
    CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
    CHECK(std::includes(objects.begin(), objects.end(), ids.begin(), ids.end()));
    named += ids.size();
    for (const ObjectId id : objects) {
      const bool reaches = reachesInto(plan, scene, id);
      inside += reaches;
      if (reaches) CHECK(std::binary_search(ids.begin(), ids.end(), id));
    }
  }
  CHECK(inside > 50);
  CHECK(named < 4 * inside);
}

TEST_CASE("scopes are out of range while an object is too far away for the tree") {
  Scene scene;
  const MeshId mesh = test::add(scene, tools::makeBox({1, 1, 1}));
  const auto at = [](double x) { return test::at(x, 0, 0); };
  const ObjectId near = scene.addObject({mesh, at(0), ~0u});
  scene.addObject({mesh, at(50), ~0u});
  const ObjectId remote = scene.addObject({mesh, at(1e30), ~0u});
  const Query query{.mesh = mesh, .worldFromMesh = at(0), .direction = {0, 0, 1}, .distance = 1};
  CHECK(planOf(scene, query).outOfRange == "range: an object has coordinates beyond 2^80");
  scene.removeObject(remote);
  CHECK(selectedBy(planOf(scene, query)) == std::vector<ObjectId>{near});
}

TEST_CASE("the box around turned vertices has the bits of the outermost, whatever the number of vertices") {
  tools::Random random(12);
  for (const uint32_t count : {3u, 4u, 5u, 7u, 8u, 63u, 1234u}) {
    tools::MeshData shape;
    for (uint32_t i = 0; i < count; ++i) {
      for (const double x : random.inCube(10)) shape.positions.push_back(static_cast<float>(x));
      for (const uint32_t corner : {i, (i + 1) % count, (i + 2) % count}) shape.indices.push_back(corner);
    }
    // The outermost vertex is a different one each time, so that each lane has it, and the rest after whole lanes.
    for (uint32_t outermost = 0; outermost < std::min(count, 9u); ++outermost) {
      const uint32_t vertex = count - 1 - outermost;
      for (int k = 0; k < 3; ++k) shape.positions[3 * vertex + k] *= 8;
      Scene scene;
      const Mesh& mesh = scene.impl().meshes[test::add(scene, shape)];
      const Affine m = tools::makePose(random.rotation(), {1, 2, 3}, {4, 5, 6}).m;
      const Box box = tightBox(mesh, m);
      for (int row = 0; row < 3; ++row) {
        float low = 3e38f, high = -3e38f;
        for (uint32_t i = 0; i < count; ++i) {
          float at = static_cast<float>(m[4 * row]) * mesh.local[0][i];
          at += static_cast<float>(m[4 * row + 1]) * mesh.local[1][i];
          at += static_cast<float>(m[4 * row + 2]) * mesh.local[2][i];
          low = std::min(low, at);
          high = std::max(high, at);
        }
        CHECK(box.lo[row] == low + m[4 * row + 3]);
        CHECK(box.hi[row] == high + m[4 * row + 3]);
      }
    }
  }
}
