#include "cpu/query_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu/clearance.h"
#include "query/swept.h"

namespace radar::cpu {

namespace {

Query stillAt(const Query& query) {
  Query still = query;
  still.distance = 0;
  if (query.motion) still.motion = Vector{};
  return still;
}

}  // namespace

void toDistances(Result& result, double distance) {
  // A bracket's ends are equal only at the start or the end. The floor is what a product may lose if it is subnormal.
  const bool isExact = result.lo == result.hi;
  const double rounding = isExact ? 0 : 2 * kUnit, floor = isExact ? 0 : std::numeric_limits<double>::denorm_min();
  const auto scaled = [&](double t, double outwards) { return std::isinf(t) ? t : outwards * t * distance; };
  const bool isLo = result.t == result.lo;
  result.lo = std::max(scaled(result.lo, 1 - rounding) - floor, 0.0);
  result.t = isLo ? result.lo : scaled(result.t, 1);
  result.hi = std::isinf(result.hi) ? result.hi : std::min(scaled(result.hi, 1 + rounding) + floor, distance);
}

/// A query, prepared for the search.
struct QuerySearch::Task {
  const Query& query;
  const Scene::Impl& scene;
  const Mesh& sensor;
  bool isStep;
  Vector displacement{};  ///< of the sensor during a step
  Motion motion;          ///< of the sensor
  MeshPlacement placement;
  MeshAxes axes;
  double magnitude = 0;
  bool mirrored = false;

  Task(const Query& q, const Scene::Impl& s)
      : query(q),
        scene(s),
        sensor(s.meshes[q.mesh]),
        isStep(radar::isStep(q, s)),
        displacement(isStep ? displacementOf(q) : Vector{}),
        motion(isStep ? Motion(displacement, {}) : Motion(q)),
        placement(sensor, q.worldFromMesh),
        axes(placement.linear) {
    if (!query.ignoreLeaving && !query.skipOverlapping) return;
    magnitude = placedMagnitude(sensor.farthest, query.worldFromMesh);
    mirrored = exact::isMirroring(query.worldFromMesh);
  }
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  /// How pairs with an object are judged. Computed only if the query needs it.
  PairRule ruleFor(ObjectId id) const {
    if (!query.ignoreLeaving && !query.skipOverlapping) return {};
    const Object& object = scene.objects[id].object;
    const double farthest = placedMagnitude(scene.meshes[object.mesh].farthest, object.worldFromMesh);
    const double slack = query.slack ? *query.slack : exact::defaultSlack(std::max(magnitude, farthest));
    return {slack, {mirrored, exact::isMirroring(object.worldFromMesh)}};
  }
};

Result QuerySearch::answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists,
                           const std::stop_token& stop) {
  stop_ = &stop;
  std::vector<ObjectId> skipped;
  if (query.skipOverlapping) skipped = overlapping(query, scene, tree);
  const Task task(query, scene);
  const auto find = [&](auto&& finder) {
    const auto wants = [&](double near) {
      return !finder.isDecided() && near <= task.motion.wayUntil(finder.latest());
    };
    walk(query, task.motion, scene, tree, wants, [&](ObjectId id) {
      if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
      search(task, id, finder);
      finder.endObject();
    });
    const bool scales = task.isStep && !query.motion;
    if (lists != nullptr) {
      *lists = {finder.nearest(), skipped};
      for (Result& hit : lists->hits) {
        if (scales) toDistances(hit, query.distance);
      }
    }
    Result first = finder.first();
    if (scales) toDistances(first, query.distance);
    return first;
  };
  if (query.clearance > 0) {
    Result first = find(ClearanceContact(query, task.motion, toleranceOf(query, task.sensor)));
    describeStart(query, scene, tree, skipped, first, lists);
    return first;
  }
  return find(FirstContact(query, task.motion));
}

std::vector<ObjectId> QuerySearch::overlapping(const Query& query, const Scene::Impl& scene, const ObjectTree& tree) {
  Query still = stillAt(query);
  still.clearance = 0;
  const Task task(still, scene);
  std::vector<ObjectId> found;
  CrossingTest test;
  walk(
      still, task.motion, scene, tree, [](double near) { return near <= 0; },
      [&](ObjectId id) {
        search(task, id, test);
        if (test.endObject()) found.push_back(id);
      });
  std::sort(found.begin(), found.end());
  return found;
}

void QuerySearch::describeStart(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                                std::span<const ObjectId> skipped, Result& first, Listed* lists) {
  if (first.status != Status::overlap) return;
  const Query still = stillAt(query);
  const Task task(query, scene);
  NearestAtStart nearest(query);
  const PlacedMesh sensor{task.sensor, query.worldFromMesh, task.placement};
  const auto consider = [&](ObjectId id, NearestAtStart& finder) {
    const Object& object = scene.objects[id].object;
    const Mesh& mesh = scene.meshes[object.mesh];
    const Motion motion = motionPast(query, scene, id);
    finder.beginObject(task.ruleFor(id), motion);
    nearest_.run(sensor, {mesh, object.worldFromMesh, MeshPlacement(mesh, object.worldFromMesh)}, id, finder, pairs_,
                 *stop_);
  };
  walk(
      still, Motion(Vector{}, {}), scene, tree, [](double near) { return near <= 0; },
      [&](ObjectId id) {
        if (!std::binary_search(skipped.begin(), skipped.end(), id)) consider(id, nearest);
      });
  nearest.describe(first);
  for (size_t i = 0; lists != nullptr && i < lists->hits.size(); ++i) {
    Result& hit = lists->hits[i];
    if (hit.status != Status::overlap) continue;
    NearestAtStart own(query);
    consider(hit.object, own);
    own.describe(hit);
  }
}

template <class Finder>
void QuerySearch::search(const Task& task, ObjectId id, Finder& finder) {
  const PairRule rule = task.ruleFor(id);
  const Motion& motion =
      task.isStep ? past_.emplace(task.displacement, task.scene.objects[id].object.motion) : task.motion;
  finder.beginObject(rule, motion);
  searchObject(task, id, rule, motion, finder);
}

void QuerySearch::searchObject(const Task& task, ObjectId id, const PairRule& rule, const Motion& motion,
                               PairVisitor& visitor) {
  throwIfStopped(*stop_);
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (visitor.isBefore({id, mesh.tree.below[0].least, 0})) return;

  const gpu::MeshNode &rootA = task.sensor.tree.nodes[0], &rootB = mesh.tree.nodes[0];
  const MeshPlacement placement(mesh, object.worldFromMesh);
  // Faces that are pressed together may have passed each other by the slack.
  const double room = task.query.ignoreLeaving ? 2 * rule.slack : 0;
  const PairMotion pairMotion(task.placement, placement, motion, std::max(task.query.clearance, room),
                              visitor.latest());
  TimeSpan times;
  // The sensor's axes come first: they rule out most objects, and those of the object need a matrix inverse.
  const RelativePlacement fromSensor(task.axes, placement, pairMotion, -1);
  narrow(times, fromSensor, rootA, rootB);
  if (times.empty()) return;
  const RelativePlacement fromObject(MeshAxes(placement.linear), task.placement, pairMotion, 1);
  narrow(times, fromObject, rootB, rootA);
  if (times.empty()) return;
  const MeshPair pair{{task.sensor, task.query.worldFromMesh, task.placement},
                      {mesh, object.worldFromMesh, placement},
                      id,
                      pairMotion,
                      fromSensor,
                      fromObject};
  meshes_.run(pair, times.from, visitor, pairs_, *stop_);
}

}  // namespace radar::cpu
