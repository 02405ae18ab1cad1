#include "faults/scenario.h"

#include "embed/execute.h"
#include "support/same_bits.h"
#include "support/world.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"

namespace radar::test {

namespace {

using tools::operator-;

tools::Workload soups(uint32_t sensors) {
  return tools::makeWorkload(tools::Soups{.objects = 8, .sensors = sensors, .triangles = 8, .seed = 71});
}

// Aims a query at one object after the other, so that most meet something.
Query aimed(const tools::Workload& workload, size_t i) {
  Query query = workload.queries[i];
  query.resolution = 16;
  const std::vector<tools::Instance>& objects = workload.scenes[0].instances;
  const Transform& target = objects[i % objects.size()].worldFromMesh;
  query.direction = placeOf(target) - placeOf(query.worldFromMesh);
  query.distance = tools::lengthOf(query.direction);
  return query;
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
  for (uint32_t i = 0; i < count; ++i) {
    Query query = aimed(workload, i);
    const uint32_t kind = i % 12;  // of some, nothing is asked but where they meet something first
    query.anyHit = kind == 1;
    query.hits = kind == 2 ? 3 : kind == 3 ? kAllHits : kind == 9 ? 2 : 1;
    query.skipOverlapping = kind == 3 || kind == 8;
    query.ignoreLeaving = kind == 4;
    query.closest = query.exit = kind == 9 || kind == 10;
    query.clearance = kind == 5 || kind == 9 ? 0.05 : 0;
    if (kind == 6) tools::takeStep(query);
    if (kind == 7) query.mask = 1;
    if (kind == 7) query.exclude = {0, 5};
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
  return differenceOf(p, q).empty();
}

bool sameContacts(const Answers& p, const Answers& q) {
  return differenceOf(p, q, sameButTier).empty();
}

}  // namespace radar::test
