#include "python/page.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "view/page.h"
#include "workloads/answer_fields.h"
#include "workloads/query_fields.h"

namespace radar::python {

using tools::Workload;

Workload workloadOf(const BasedScene& based, const std::map<uint32_t, std::string>& objectNames) {
  const Scene& scene = based.scene();
  Workload workload;
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    tools::MeshData& mesh = workload.meshes.emplace_back();
    mesh.name = "mesh " + std::to_string(id);
    mesh.radius = based.radius(id);
    if (!scene.hasMesh(id)) continue;
    mesh.cutter = based.cutter(id);
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

std::string castsPage(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                      const std::string& title, uint64_t count, const std::vector<std::string>& names,
                      const py::dict& arrays, const py::array& records, const std::map<uint32_t, std::string>& reasons,
                      const tools::LeftOut& left, const std::optional<std::pair<py::array, Array<int64_t>>>& hits,
                      const std::optional<py::array>& closest, const std::optional<py::array>& exits) {
  const size_t shown = names.size();
  const auto* const meshes = numbers<uint32_t>(arrays, "mesh", shown);
  const auto *const poses = numbers<double>(arrays, "poses", 16 * shown),
                    *const directions = numbers<double>(arrays, "displacements", 3 * shown),
                    *const distances = numbers<double>(arrays, "distances", shown);
  const auto excluded = arrays["exclude_from_each"].cast<Array<int64_t>>();
  const bool isSampled = static_cast<size_t>(records.itemsize()) == tools::castsLayout(true).size;
  const tools::AnswerLayout &layout = tools::castsLayout(isSampled), &ofHits = tools::castsLayout(false);
  const char* const answers = recordsOf(records, layout, shown);
  const char* const listed =
      hits ? recordsOf(hits->first, ofHits, static_cast<size_t>(hits->second.at(shown))) : nullptr;

  Workload workload = workloadOf(scene.based(), objectNames);
  std::vector<Result> results;
  tools::PageContent content{.title = title, .queries = count, .reasons = reasons, .left = left};
  for (size_t i = 0; i < shown; ++i) {
    tools::QuerySpec& query = workload.queries.emplace_back();
    query.id = names[i];
    query.mesh = meshes[i];
    query.worldFromMesh = scene.based().placed(query.mesh, transformFrom(poses + 16 * i));
    std::copy_n(directions + 3 * i, 3, query.direction.begin());
    query.distance = distances[i];
    if (arrays.contains("turns: axes")) {
      query.motion = std::exchange(query.direction, {});
      query.distance = 0;
      Turn& turn = query.turn.emplace();
      std::copy_n(numbers<double>(arrays, "turns: axes", 3 * shown) + 3 * i, 3, turn.axis.begin());
      turn.angle = numbers<double>(arrays, "turns: angles", shown)[i];
      std::copy_n(numbers<double>(arrays, "turns: centres", 3 * shown) + 3 * i, 3, turn.centre.begin());
    }
    for (const tools::QueryField& field : tools::queryFields()) {
      if (!field.cast) continue;
      const double value = numbers<double>(arrays, field.name, shown)[i];
      tools::setValue(query, field, field.word && value == 0 ? std::numeric_limits<double>::infinity() : value);
    }
    query.clearance = tools::withRadius(query.clearance, scene.based().radius(query.mesh));
    for (py::ssize_t k = 0; k < excluded.shape(1); ++k) {
      if (const int64_t object = excluded.at(i, k); object >= 0) query.exclude.push_back(static_cast<ObjectId>(object));
    }
    results.push_back(layout.read(answers + layout.size * i));
    Listed own;
    for (int64_t k = hits ? hits->second.at(i) : 0; k < (hits ? hits->second.at(i + 1) : 0); ++k) {
      own.hits.push_back(ofHits.read(listed + ofHits.size * static_cast<size_t>(k)));
    }
    if (closest) own.closest = Closest{0, 0, ofHits.read(recordsOf(*closest, ofHits, shown) + ofHits.size * i)};
    if (exits) own.exit = ofHits.read(recordsOf(*exits, ofHits, shown) + ofHits.size * i);
    if (auto moments = tools::momentsOf(own); !moments.empty()) {
      content.moments[static_cast<uint32_t>(i)] = std::move(moments);
    }
  }
  return tools::pageOf(workload, results, content);
}

}  // namespace radar::python
