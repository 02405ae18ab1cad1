#include "embed/recorded.h"

#include <algorithm>

#include "contact/decode.h"
#include "cpu/clearance.h"
#include "embed/host_queries.h"
#include "query/route.h"
#include "query/swept.h"

namespace radar {

namespace {

// Of a query past one object each: lavapipe ends longer loops silently.
constexpr size_t kMostSearches = 1u << 15;

Result outOfRange() {
  Result result;
  result.tier = Tier::contact;
  result.flags = Flag::range;
  return result;
}

// The objects in reach of a query, ascending, and those that may be, wherever the host moves them: every object if only
// the device knows how large the sensor is.
std::vector<ObjectId> mayReach(const Query& query, const Scene::Impl& scene, const HostGeometryPass& geometry) {
  std::vector<ObjectId> objects = inReach(query, scene, scene.objectTree(), roomyBox(query, scene));
  const Participants participants(query, scene);
  const auto add = [&](ObjectId id) {
    if (scene.objects[id].used && participants.contain(id)) objects.push_back(id);
  };
  if (geometry.isUnbounded(query.mesh)) {
    for (ObjectId id = 0; id < scene.objects.size(); ++id) add(id);
  } else {
    for (const ObjectId id : geometry.unbounded()) add(id);
  }
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
  return objects;
}

}  // namespace

void Recorded::plan(std::span<const Query> asked, const Scene::Impl& scene, const HostGeometryPass& geometry,
                    uint32_t mostSearches) {
  isWritten = false;
  count = static_cast<uint32_t>(asked.size());
  queries.assign(asked.begin(), asked.end());
  searches.clear();
  gathered.clear();
  hitOffsets.clear();
  tolerances.clear();
  const bool isInRange = scene.objectTree().inRange();
  std::vector<std::vector<ObjectId>> objects(count);
  size_t pastOneObject = 0;
  uint32_t end = count;
  for (uint32_t i = 0; i < count; ++i) {
    const Query& query = queries[i];
    const bool searchesEach = isInRange && routeOf(query, scene, false) == Route::searchEach;
    objects[i] = searchesEach ? mayReach(query, scene, geometry) : std::vector<ObjectId>{kNone};
    const auto several = static_cast<uint32_t>(searchesEach ? objects[i].size() : 0);
    if (several > kMostSearches) {
      throw Error("query " + std::to_string(i) + ": expected at most " + std::to_string(kMostSearches) +
                  " objects in reach, got " + std::to_string(several));
    }
    pastOneObject += several;
    hitOffsets.push_back(end);
    const uint32_t listed = query.hits > 1 ? std::min(query.hits, several) : 0;
    if (several > 0) gathered.push_back({.query = i, .first = 0, .count = several, .list = end, .listed = listed});
    end += listed;
    tolerances.push_back(cpu::toleranceOf(query, scene.meshes[query.mesh]));
  }
  if (pastOneObject > mostSearches) {
    throw Error("expected at most " + std::to_string(mostSearches) +
                " searches past one object each (Capacity::searches), got " + std::to_string(pastOneObject));
  }
  hitOffsets.push_back(end);
  known.assign(end, clearAnswer());
  auto next = gathered.begin();
  for (uint32_t i = 0; i < count; ++i) {
    const bool takesSeveral = next != gathered.end() && next->query == i;
    if (takesSeveral) next++->first = static_cast<uint32_t>(known.size());
    const uint32_t first = searches.count();
    for (const ObjectId object : objects[i]) {
      const uint32_t result = takesSeveral ? static_cast<uint32_t>(known.size()) : i;
      if (takesSeveral) known.push_back(clearAnswer());
      planSearch(queries[i], result, object, scene, geometry);
    }
    searches.group(i, first);
  }
}

void Recorded::planSearch(const Query& query, uint32_t result, ObjectId object, const Scene::Impl& scene,
                          const HostGeometryPass& geometry) {
  const Planned planned = searches.add(query, result, scene, scene.objectTree(), object);
  if (planned == Planned::outOfRange) known[result] = outOfRange();
  if (planned == Planned::added && geometry.isUnbounded(query.mesh)) searches.sweeps.back().magnitude = -1;
}

void Recorded::planWritten(uint32_t most) {
  isWritten = true;
  count = most;
  queries.clear();
  gathered.clear();
  hitOffsets.assign(size_t{most} + 1, most);
  tolerances.clear();
  known.clear();
}

void Recorded::learn(const std::map<MeshId, Box>& boxes) {
  if (boxes.empty()) return;
  std::vector<Vector> all = *farthest;
  for (const auto& [mesh, box] : boxes) {
    Mesh shape;
    setBox(shape, box);
    all[mesh] = shape.farthest;
    for (size_t i = 0; i < queries.size(); ++i) {
      if (queries[i].mesh == mesh) tolerances[i] = cpu::toleranceOf(queries[i], shape);
    }
  }
  farthest = std::make_shared<const std::vector<Vector>>(std::move(all));
}

Answers Recorded::answers(std::vector<Result> all, std::span<const gpu::UnresolvedPair> pairs) const {
  decideAll(pairs, {.farthest = *farthest}, [&](uint32_t search, ObjectId) {
    const gpu::Sweep& sweep = searches.sweeps[search];
    const size_t number = groupOf(searches.groups, search).query;
    const Query& query = queries[number];
    // The object may move otherwise by now.
    const Vector drift{sweep.drift[0], sweep.drift[1], sweep.drift[2]};
    return OpenSearch{all[sweep.result], query, query.motion ? Translation(*query.motion, drift) : Translation(query),
                      tolerances[number]};
  });
  Answers answers = unanswered(queries);
  std::copy_n(all.begin(), count, answers.results.begin());
  for (const gpu::Gathered& several : gathered) {
    Merged found = merged(std::span(all).subspan(several.first, several.count), several.listed);
    answers.results[several.query] = found.first;
    if (!answers.lists.empty()) answers.lists[several.query].hits = std::move(found.hits);
  }
  return answers;
}

Answers Recorded::answersToWritten(std::vector<Result> all, std::span<const gpu::UnresolvedPair> pairs,
                                   const gpu::Sweep* sweeps) const {
  decideAll(pairs, {.farthest = *farthest}, [&](uint32_t search, ObjectId) {
    const Query query = queryOf(sweeps[search]);
    return OpenSearch{all[search], query, Translation(query)};
  });
  return {.results = std::move(all)};
}

}  // namespace radar
