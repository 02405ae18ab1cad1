#include "cpu/query_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu/clearance.h"
#include "cpu/swept_box.h"

namespace radar::cpu {

namespace {

Vector middleOf(const Mesh& mesh, const Placement& placement) {
  Vector middle = placement.origin;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) middle[i] += placement.linear[i][k] * mesh.tree.nodes[0].centre[k];
  }
  return middle;
}

/// Prefetches the child nodes or the object of a node, because a scene's tree and objects do not fit a cache.
void prefetch(const gpu::ObjectNode& node, const std::vector<gpu::ObjectNode>& nodes, const Scene::Impl& scene) {
  const uint32_t item = node.link & gpu::kLinkItem;
  const void* next = &nodes[0] + item;
  if ((node.link & gpu::kLinkLeaf) != 0) next = &scene.objects[item];
  __builtin_prefetch(next);
  __builtin_prefetch(static_cast<const char*>(next) + 64);
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
  std::span<const ObjectId> overlapping;  ///< ascending; not eligible
  const Mesh& sensor;
  bool isStep;
  Vector displacement{};  ///< of the sensor during a step
  Motion motion;          ///< of the sensor
  Placement placement;
  MeshAxes axes;
  double magnitude = 0;
  bool mirrored = false;

  Task(const Query& q, const Scene::Impl& s, std::span<const ObjectId> skipped)
      : query(q),
        scene(s),
        overlapping(skipped),
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

  /// Whether the object shares a mask bit with the query and is neither excluded nor skipped.
  bool isEligible(ObjectId id) const {
    if ((scene.objects[id].object.mask & query.mask) == 0) return false;
    return std::find(query.exclude.begin(), query.exclude.end(), id) == query.exclude.end() &&
           !std::binary_search(overlapping.begin(), overlapping.end(), id);
  }

  /// How pairs with an object are judged. Computed only if the query needs it.
  PairRule ruleFor(ObjectId id) const {
    if (!query.ignoreLeaving && !query.skipOverlapping) return {};
    const Object& object = scene.objects[id].object;
    const double farthest = placedMagnitude(scene.meshes[object.mesh].farthest, object.worldFromMesh);
    const double slack = query.slack ? *query.slack : exact::defaultSlack(std::max(magnitude, farthest));
    return {slack, {mirrored, exact::isMirroring(object.worldFromMesh)}};
  }
};

Result QuerySearch::answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists) {
  std::vector<ObjectId> skipped;
  if (query.skipOverlapping) skipped = overlapping(query, scene, tree);
  const Task task(query, scene, skipped);
  const Vector& extent = task.placement.extent;
  const double size = std::max({extent[0], extent[1], extent[2]});
  const auto find = [&](auto&& finder) {
    forObjects(task, tree, finder, [&](ObjectId id) {
      search(task, id, finder);
      finder.endObject();
    });
    const bool scales = task.isStep && !query.motion;
    if (lists != nullptr) {
      *lists = {finder.nearest(), std::move(skipped)};
      for (Result& hit : lists->hits) {
        if (scales) toDistances(hit, query.distance);
      }
    }
    Result first = finder.first();
    if (scales) toDistances(first, query.distance);
    return first;
  };
  if (query.clearance > 0) return find(ClearanceContact(query, task.motion, toleranceOf(query, task.sensor)));
  return find(FirstContact(query, task.motion, middleOf(task.sensor, task.placement), size));
}

std::vector<ObjectId> QuerySearch::inReach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree) {
  const Task task(query, scene, {});
  std::vector<ObjectId> found;
  forObjects(task, tree, CrossingTest(task.motion.distance), [&](ObjectId id) { found.push_back(id); });
  return found;
}

std::vector<ObjectId> QuerySearch::overlapping(const Query& query, const Scene::Impl& scene, const ObjectTree& tree) {
  Query still = query;
  still.distance = still.clearance = 0;
  if (query.motion) still.motion = Vector{};
  const Task task(still, scene, {});
  std::vector<ObjectId> found;
  CrossingTest test(0);
  forObjects(task, tree, test, [&](ObjectId id) {
    search(task, id, test);
    if (test.endObject()) found.push_back(id);
  });
  std::sort(found.begin(), found.end());
  return found;
}

template <class SearchObject>
void QuerySearch::forObjects(const Task& task, const ObjectTree& tree, const PairVisitor& visitor,
                             const SearchObject& search) {
  if (!tree.inRange()) {
    for (ObjectId id = 0; id < task.scene.objects.size(); ++id) {
      if (task.scene.objects[id].used && !visitor.isDecided() && task.isEligible(id)) search(id);
    }
    return;
  }
  const std::vector<gpu::ObjectNode>& nodes = tree.nodes();
  if (nodes.empty()) return;
  Box box = boxOf(task.sensor, task.query.worldFromMesh.m);
  // Boxes have room for the default slack.
  const double room = std::max(task.query.clearance, 2 * task.query.slack.value_or(0));
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= room;
    box.hi[k] += room;
  }
  const SweptBox meets(box, task.motion, tree);
  const auto isWanted = [&](double near) { return near <= task.motion.wayUntil(visitor.latest()); };
  open_.resize(size_t{tree.depth()} + 2);
  Open* top = open_.data();
  const auto push = [&](double near, const gpu::ObjectNode& node) {
    *top = {near, node.link};
    top += isWanted(near);
  };
  push(meets(nodes[0], nodes[0])[0], nodes[0]);
  while (top != open_.data() && !visitor.isDecided()) {
    const Open next = *--top;
    if (!isWanted(next.near)) continue;
    if ((next.link & gpu::kLinkLeaf) != 0) {
      const ObjectId id = next.link & gpu::kLinkItem;
      if (task.isEligible(id)) search(id);
      continue;
    }
    const gpu::ObjectNode &left = nodes[next.link], &right = nodes[next.link + 1];
    prefetch(left, nodes, task.scene);
    prefetch(right, nodes, task.scene);
    const TwoDoubles near = meets(left, right);
    const bool leftFirst = near[0] <= near[1];
    push(leftFirst ? near[1] : near[0], leftFirst ? right : left);
    push(leftFirst ? near[0] : near[1], leftFirst ? left : right);
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
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (visitor.isBefore({id, mesh.tree.below[0].least, 0})) return;

  const gpu::MeshNode &rootA = task.sensor.tree.nodes[0], &rootB = mesh.tree.nodes[0];
  const Placement placement(mesh, object.worldFromMesh);
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
  const MeshPair pair{
      {task.sensor, task.query.worldFromMesh}, {mesh, object.worldFromMesh}, id, pairMotion, fromSensor, fromObject};
  meshes_.run(pair, times.from, visitor, pairs_);
}

}  // namespace radar::cpu
