#include "python/page.h"

#include <algorithm>
#include <limits>

#include "view/page.h"

namespace radar::python {

namespace {

using tools::Workload;

/// Numbers of meshes and objects are the scene's.
Workload workloadOf(const Scene& scene, const std::map<uint32_t, std::string>& objectNames) {
  Workload workload;
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    tools::MeshData& mesh = workload.meshes.emplace_back();
    mesh.name = "mesh " + std::to_string(id);
    if (!scene.hasMesh(id)) continue;
    const MeshView view = scene.mesh(id);
    mesh.positions.assign(view.positions.begin(), view.positions.end());
    mesh.indices.assign(view.indices.begin(), view.indices.end());
  }
  tools::SceneSpec& spec = workload.scenes.emplace_back();
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    tools::Instance& instance = spec.instances.emplace_back();
    instance.mesh = kNone;
    if (!scene.hasObject(id)) continue;
    const Object& object = scene.object(id);
    instance = {object.mesh, object.worldFromMesh};
    if (object.motion != std::array<double, 3>{}) spec.motions.emplace_back(id, object.motion);
    if (object.mask != ~0u) spec.masks.emplace_back(id, object.mask);
  }
  if (!objectNames.empty()) spec.names.resize(spec.instances.size());
  for (const auto& [id, name] : objectNames) spec.names.at(id) = name;
  return workload;
}

uint32_t idFrom(int64_t number) {
  return number < 0 ? kNone : static_cast<uint32_t>(number);
}

Result resultOf(const BatchOutput& answers, size_t i) {
  Result result(static_cast<Status>(answers.status[i]));
  result.t = answers.distance[i];
  result.lo = answers.lo[i];
  result.hi = answers.hi[i];
  result.object = idFrom(answers.object[i]);
  result.triA = idFrom(answers.triangles[2 * i]);
  result.triB = idFrom(answers.triangles[2 * i + 1]);
  std::copy_n(answers.point + 3 * i, 3, result.point.begin());
  std::copy_n(answers.normal + 3 * i, 3, result.normal.begin());
  result.gap = answers.gap[i];
  return result;
}

}  // namespace

std::string pageOf(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                   const std::string& title, const ShownCasts& casts) {
  Workload workload = workloadOf(scene.scene(), objectNames);
  std::vector<Result> results;
  tools::PageContent content;
  for (size_t i = 0; i < casts.names.size(); ++i) {
    tools::QuerySpec& query = workload.queries.emplace_back();
    query.id = casts.names[i];
    query.mesh = casts.meshes[i];
    std::copy_n(casts.poses + 16 * i, 12, query.worldFromMesh.m.begin());
    query.worldFromMesh = scene.based().placed(query.mesh, query.worldFromMesh);
    std::copy_n(casts.directions + 3 * i, 3, query.direction.begin());
    query.distance = casts.distances[i];
    for (const auto& [field, values] : casts.options) {
      const bool isWord = field->word != nullptr && values[i] == 0;
      tools::setValue(query, *field, isWord ? std::numeric_limits<double>::infinity() : values[i]);
    }
    for (size_t k = 0; k < casts.excludedCount; ++k) {
      const int64_t object = casts.excluded[casts.excludedCount * i + k];
      if (object >= 0) query.exclude.push_back(idFrom(object));
    }
    results.push_back(resultOf(casts.answers, i));
    if (casts.hitOffsets == nullptr) continue;
    for (int64_t k = casts.hitOffsets[i]; k < casts.hitOffsets[i + 1]; ++k) {
      content.hits[static_cast<uint32_t>(i)].push_back(resultOf(casts.hits, static_cast<size_t>(k)));
    }
  }
  content.title = title;
  content.queries = casts.count;
  content.reasons = casts.reasons;
  content.left = casts.left;
  return tools::pageOf(workload, results, content);
}

}  // namespace radar::python
