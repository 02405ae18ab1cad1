#include "faults/scenario.h"

#include <algorithm>
#include <cmath>

#include "embed/execute.h"
#include "support/same_bits.h"
#include "workloads/generate.h"

namespace radar::test {

namespace {

tools::Workload soups(uint32_t sensors) {
  return tools::makeWorkload(tools::Soups{.objects = 8, .sensors = sensors, .triangles = 8, .seed = 71});
}

// Aims a query at one object after the other, so that most meet something.
Query aimed(const tools::Workload& workload, size_t i) {
  Query query = workload.queries[i];
  query.resolution = 16;
  const std::vector<tools::Instance>& objects = workload.scenes[0].instances;
  const Transform& target = objects[i % objects.size()].worldFromMesh;
  double squares = 0;
  for (size_t k = 0; k < 3; ++k) {
    query.direction[k] = target.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
    squares += query.direction[k] * query.direction[k];
  }
  query.distance = std::sqrt(squares);
  return query;
}

bool sameAll(std::span<const Result> p, std::span<const Result> q, bool areOfOneTier) {
  return std::ranges::equal(p, q, [&](Result a, const Result& b) {
    if (!areOfOneTier) {
      a.tier = b.tier;
      a.detected = b.detected;
    }
    return sameBits(a, b);
  });
}

bool same(const Answers& p, const Answers& q, bool areOfOneTier) {
  const auto sameLists = [&](const Listed& a, const Listed& b) {
    return sameAll(a.hits, b.hits, areOfOneTier) && a.overlapping == b.overlapping;
  };
  return sameAll(p.results, q.results, areOfOneTier) && std::ranges::equal(p.lists, q.lists, sameLists);
}

}  // namespace

SceneEdits::SceneEdits() : workload_(soups(1)), moved_(workload_.meshes[1].positions) {
  for (float& coordinate : moved_) coordinate *= 0.9f;
  pose_ = workload_.scenes[0].instances[2].worldFromMesh;
  pose_.m[3] += 0.1;
}

void SceneEdits::make(Scene& scene) const {
  for (const tools::MeshData& mesh : workload_.meshes) scene.addMesh(mesh.positions, mesh.indices);
  for (const tools::Instance& instance : workload_.scenes[0].instances) {
    scene.addObject({instance.mesh, instance.worldFromMesh});
  }
  const MeshId more = scene.addMesh(workload_.meshes[0].positions, workload_.meshes[0].indices);
  const ObjectId gone = scene.addObject({more, {}});
  scene.setBounds(gone, {{-3, -3, -3}, {3, 3, 3}});
  scene.removeObject(gone);
  scene.removeMesh(more);
  scene.setPositions(1, moved_);
  scene.setTransform(2, pose_);
  scene.setMotion(3, {0.1, 0, -0.2});
  scene.setMotion(3, {});
}

std::vector<Query> contactQueries(uint32_t count) {
  const tools::Workload workload = soups(count);
  std::vector<Query> queries;
  for (size_t i = 0; i < count; ++i) {
    Query query = aimed(workload, i);
    switch (queries.size() % 12) {
      case 1:
        query.anyHit = true;
        break;
      case 2:
        query.hits = 3;
        break;
      case 3:
        query.hits = kAllHits;
        query.skipOverlapping = true;
        break;
      case 4:
        query.ignoreLeaving = true;
        break;
      case 5:
        query.clearance = 0.05;
        break;
      case 6:
        query.motion = query.direction;
        query.direction = {};
        query.distance = 0;
        break;
      case 7:
        query.mask = 1;
        query.exclude = {0, 5};
        break;
      case 8:
        query.skipOverlapping = true;
        break;
      case 9:
        query.clearance = 0.05;
        query.hits = 2;
        break;
      default:
        break;
    }
    queries.push_back(query);
  }
  return queries;
}

std::vector<Query> recordableQueries() {
  std::vector<Query> queries = contactQueries();
  std::erase_if(queries, [atRest = Scene()](const Query& query) { return !isRecordable(query, atRest); });
  return queries;
}

std::vector<Query> sampledQueries(uint32_t count) {
  const tools::Workload workload = soups(count);
  std::vector<Query> queries;
  for (size_t i = 0; i < count; ++i) queries.push_back(aimed(workload, i));
  return queries;
}

bool sameBits(const Answers& p, const Answers& q) {
  return same(p, q, true);
}

bool sameContacts(const Answers& p, const Answers& q) {
  return same(p, q, false);
}

}  // namespace radar::test
