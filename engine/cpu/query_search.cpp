#include "cpu/query_search.h"

#include <algorithm>
#include <cmath>

#include "cpu/clearance.h"
#include "query/swept.h"

namespace radar::cpu {

/// A query, prepared for the search.
struct QuerySearch::Task {
  const Query& query;
  const Scene::Impl& scene;
  const Mesh& sensor;
  Course course;
  Translation motion;  ///< past objects that stand
  MeshPlacement placement;
  MeshAxes axes;
  double magnitude = 0;
  bool mirrored = false;

  Task(const Query& q, const Scene::Impl& s)
      : query(q),
        scene(s),
        sensor(s.meshes[q.mesh]),
        course(q, s),
        motion(course.past()),
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
  if (turns(query)) return answerTurn(query, scene, tree, skipped, lists);
  const Task task(query, scene);
  const auto find = [&](auto&& finder) {
    const auto wants = [&](double near) {
      return !finder.isDecided() && near <= task.motion.wayUntil(finder.latest());
    };
    walk(Participants(query, scene), tree, task.motion, roomyBox(query, scene), wants, [&](ObjectId id) {
      if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
      search(task, id, finder);
      finder.endObject();
    });
    if (lists != nullptr) {
      *lists = {finder.nearest(), skipped};
      for (Result& hit : lists->hits) task.course.toQuery(hit);
    }
    Result first = finder.first();
    task.course.toQuery(first);
    return first;
  };
  if (query.clearance > 0) {
    Result first = find(ClearanceContact(query, task.motion, toleranceOf(query, task.sensor)));
    describeStart(query, scene, tree, skipped, first, lists);
    return first;
  }
  return find(FirstContact(query, task.motion));
}

Result QuerySearch::answerTurn(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                               std::span<const ObjectId> skipped, Listed* lists) {
  const Task task(query, scene);
  const TurnMotion motion(query, task.sensor);
  TurnContact finder(query, motion,
                     pathToleranceOf(query, boxOf(task.sensor, query.worldFromMesh.m), motion.speedPast({})));
  // Of several hits, an object is searched in all parts before the next one.
  std::vector<std::pair<ObjectId, const PathPart*>> reached;
  for (const PathPart& part : motion.parts()) {
    Box start = part.start;
    for (int k = 0; k < 3; ++k) {
      start.lo[k] -= query.clearance;
      start.hi[k] += query.clearance;
    }
    const auto wants = [&](double near) {
      return !finder.isDecided() && finder.latest() >= part.from && near <= part.piece.wayUntil(finder.latest());
    };
    walk(Participants(query, scene), tree, part.piece, start, wants, [&](ObjectId id) {
      if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
      if (query.hits > 1) return reached.emplace_back(id, &part), void();
      searchTurning(task, id, motion, part, finder);
    });
  }
  std::ranges::stable_sort(reached, {}, [](const auto& one) { return one.first; });
  for (size_t i = 0; i < reached.size(); ++i) {
    searchTurning(task, reached[i].first, motion, *reached[i].second, finder);
    if (i + 1 == reached.size() || reached[i + 1].first != reached[i].first) finder.endObject();
  }
  Result first = finder.first();
  if (lists != nullptr) *lists = {finder.nearest(), {skipped.begin(), skipped.end()}};
  if (first.status == Status::overlap) {
    Query still = query;
    still.motion = Vector{};
    still.turn.reset();
    if (query.clearance > 0) {
      describeStart(still, scene, tree, skipped, first, lists);
    } else {
      // Names the least pair, exactly.
      still.hits = 1;
      still.exclude.insert(still.exclude.end(), skipped.begin(), skipped.end());
      still.skipOverlapping = false;
      first = answer(still, scene, tree, nullptr, *stop_);
    }
  }
  return first;
}

void QuerySearch::searchTurning(const Task& task, ObjectId id, const TurnMotion& motion, const PathPart& part,
                                TurnContact& finder) {
  throwIfStopped(*stop_);
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (finder.isBefore({id, mesh.tree.below[0].least, 0})) return;
  const MeshPlacement placement(mesh, object.worldFromMesh);
  finder.beginObject(object.motion);
  const PlacedMesh sensor{task.sensor, task.query.worldFromMesh, task.placement};
  PathPair pair =
      pairOf(sensor, part, {mesh, object.worldFromMesh, placement}, id, object.motion, task.query.clearance);
  pair.bendSeen = motion.bendSeen(part, object.motion);
  pair.axis = motion.turning().axis();
  meshes_.run(pair, finder, pairs_, *stop_);
}

std::vector<ObjectId> QuerySearch::overlapping(const Query& query, const Scene::Impl& scene, const ObjectTree& tree) {
  Query still = query;
  still.distance = still.clearance = 0;
  if (query.motion || query.turn) still.motion = Vector{};
  still.turn.reset();
  const Task task(still, scene);
  std::vector<ObjectId> found;
  CrossingTest test;
  walk(
      Participants(still, scene), tree, task.motion, roomyBox(still, scene), [](double near) { return near <= 0; },
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
  const Task task(query, scene);
  NearestAtStart nearest(query);
  const PlacedMesh sensor{task.sensor, query.worldFromMesh, task.placement};
  const auto consider = [&](ObjectId id, NearestAtStart& finder) {
    const Object& object = scene.objects[id].object;
    const Mesh& mesh = scene.meshes[object.mesh];
    const Translation motion = task.course.past(id);
    finder.beginObject(task.ruleFor(id), motion);
    nearest_.run(sensor, {mesh, object.worldFromMesh, MeshPlacement(mesh, object.worldFromMesh)}, id, finder, pairs_,
                 *stop_);
  };
  walk(
      Participants(query, scene), tree, Translation(Vector{}, {}), roomyBox(query, scene),
      [](double near) { return near <= 0; },
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
  const Translation& motion = task.course.isStep() ? past_.emplace(task.course.past(id)) : task.motion;
  finder.beginObject(rule, motion);
  // Faces that are pressed together may have passed each other by the slack.
  const double room = task.query.ignoreLeaving ? 2 * rule.slack : 0;
  searchObject(task, id, motion, std::max(task.query.clearance, room), finder);
}

void QuerySearch::searchObject(const Task& task, ObjectId id, const Piece& piece, double clearance,
                               PairVisitor& visitor) {
  throwIfStopped(*stop_);
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (visitor.isBefore({id, mesh.tree.below[0].least, 0})) return;

  const gpu::MeshNode &rootA = task.sensor.tree.nodes[0], &rootB = mesh.tree.nodes[0];
  const MeshPlacement placement(mesh, object.worldFromMesh);
  const PairMotion pairMotion(task.placement, placement, piece, clearance, visitor.latest());
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
