#include "cpu/query_search.h"

#include <algorithm>

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

/// A query, prepared for the search.
struct QuerySearch::Task {
  const Query& query;
  const Scene::Impl& scene;
  const Mesh& sensor;
  Motion motion;
  Placement placement;
  MeshAxes axes;
  FirstContact first;

  Task(const Query& q, const Scene::Impl& s)
      : query(q),
        scene(s),
        sensor(s.meshes[q.mesh]),
        motion(q),
        placement(sensor, q.worldFromMesh),
        axes(placement.linear),
        first(motion, q.anyHit, middleOf(sensor, placement),
              std::max({placement.extent[0], placement.extent[1], placement.extent[2]})) {}
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  /// Whether the object shares a mask bit with the query and is not excluded.
  bool isEligible(ObjectId id) const {
    if ((scene.objects[id].object.mask & query.mask) == 0) return false;
    return std::find(query.exclude.begin(), query.exclude.end(), id) == query.exclude.end();
  }
};

Result QuerySearch::answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree) {
  Task task(query, scene);
  if (tree.inRange()) {
    searchTree(task, tree);
  } else {
    for (ObjectId id = 0; id < scene.objects.size(); ++id) {
      if (scene.objects[id].used) searchObject(task, id);
    }
  }
  return task.first.result();
}

void QuerySearch::searchTree(Task& task, const ObjectTree& tree) {
  const std::vector<gpu::ObjectNode>& nodes = tree.nodes();
  if (nodes.empty()) return;
  const SweptBox meets(boxOf(task.sensor, task.query.worldFromMesh.m), task.motion, tree);
  open_.resize(size_t{tree.depth()} + 2);
  Open* top = open_.data();
  const auto push = [&](double near, const gpu::ObjectNode& node) {
    *top = {near, node.link};
    top += near <= task.first.latest();
  };
  push(meets(nodes[0], nodes[0])[0], nodes[0]);
  while (top != open_.data() && !task.first.isDecided()) {
    const Open next = *--top;
    if (next.near > task.first.latest()) continue;
    if ((next.link & gpu::kLinkLeaf) != 0) {
      searchObject(task, next.link & gpu::kLinkItem);
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

void QuerySearch::searchObject(Task& task, ObjectId id) {
  if (task.first.isDecided() || !task.isEligible(id)) return;
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (task.first.isBefore({id, mesh.tree.below[0].least, 0})) return;

  const gpu::MeshNode &rootA = task.sensor.tree.nodes[0], &rootB = mesh.tree.nodes[0];
  ++stats_.nodes;
  const Placement placement(mesh, object.worldFromMesh);
  const PairMotion motion(task.placement, placement, task.motion, task.first.latest());
  TimeSpan times;
  // The sensor's axes come first: they rule out most objects, and those of the object need a matrix inverse.
  const RelativePlacement fromSensor(task.axes, placement, motion, -1);
  narrow(times, fromSensor, rootA, rootB);
  if (times.empty()) return;
  const RelativePlacement fromObject(MeshAxes(placement.linear), task.placement, motion, 1);
  narrow(times, fromObject, rootB, rootA);
  if (times.empty()) return;
  const MeshPair pair{
      {task.sensor, task.query.worldFromMesh}, {mesh, object.worldFromMesh}, id, motion, fromSensor, fromObject};
  meshes_.run(pair, times.from, task.first, stats_);
}

}  // namespace radar::cpu
