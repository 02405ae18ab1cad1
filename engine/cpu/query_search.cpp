#include "cpu/query_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cpu/clearance.h"
#include "cpu/closest_approach.h"
#include "cpu/last_contact.h"
#include "cpu/query_task.h"
#include "query/near_walk.h"

namespace radar::cpu {

namespace {

const Piece kAtRest;

}  // namespace

template <class Finder>
Result QuerySearch::answerOf(const Task& task, const Finder& finder, std::span<const ObjectId> skipped, Listed* lists) {
  if (lists != nullptr) {
    *lists = {finder.nearest(), {skipped.begin(), skipped.end()}, {}, {}};
    for (Result& hit : lists->hits) task.course.toQuery(hit);
  }
  Result first = finder.first();
  task.course.toQuery(first);
  return first;
}

Result QuerySearch::answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists,
                           const std::stop_token& stop) {
  stop_ = &stop;
  if (!scene.meshes[query.mesh].parts.empty()) return cutters_.answer(query, scene, tree, lists, pairs_, stop);
  std::vector<ObjectId> skipped;
  if (query.skipOverlapping) skipped = overlapping(query, scene, tree);
  if (turns(query)) return answerTurn(query, scene, tree, skipped, lists);
  const Task task(query, scene);
  const auto find = [&](auto&& finder) {
    const auto reach = [&] { return reachOf(finder, task.motion); };
    walk(Participants(query, scene), tree, task.motion, roomyBox(query, scene), reach, [&](ObjectId id) {
      if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
      search(task, id, finder);
      finder.endObject();
    });
    return answerOf(task, finder, skipped, lists);
  };
  Result first;
  if (query.clearance > 0) {
    first = find(ClearanceContact(query, task.motion, toleranceOf(query, task.sensor)));
    describeStart(query, scene, tree, skipped, first, lists);
  } else {
    first = find(FirstContact(query, task.motion));
  }
  if (query.exit) lists->exit = lastContact(task, tree, skipped, first);
  if (query.closest) lists->closest = closestApproach(query, scene, tree, skipped, first);
  return first;
}

Result QuerySearch::lastContact(const Task& task, const ObjectTree& tree, std::span<const ObjectId> skipped,
                                const Result& first) {
  if (first.status == Status::clear) return first;
  const Query& query = task.query;
  const Translation& motion = task.motion;
  Box box = roomyBox(query, task.scene);
  double end = motion.end;
  if (!motion.isStep) {
    // Once the sensor has passed all objects along this axis, it touches none of them any more.
    const Box& world = tree.worldBox();
    size_t f = 0;
    for (size_t k = 1; k < 3; ++k) f = std::abs(motion.unit[k]) > std::abs(motion.unit[f]) ? k : f;
    const double way = std::max(world.hi[f] - box.lo[f], box.hi[f] - world.lo[f]) +
                       64 * kUnit * std::max(std::abs(box.lo[f]), std::abs(box.hi[f]));
    end = std::min(end, std::max(1.01 * way / std::abs(motion.unit[f]), 0.0));
  }
  Piece back;
  back.unit = scaled(-1, motion.unit);
  back.end = end;
  back.rate = motion.rate;
  for (size_t k = 0; k < 3; ++k) {
    const double shift = motion.wayUntil(end) * motion.unit[k];
    box.lo[k] += shift - 32 * kUnit * (std::abs(box.lo[k]) + std::abs(shift));
    box.hi[k] += shift + 32 * kUnit * (std::abs(box.hi[k]) + std::abs(shift));
  }
  LastContact finder(query, end, toleranceOf(query, task.sensor));
  const auto reach = [&] { return reachOf(finder, back); };
  walk(Participants(query, task.scene), tree, back, box, reach, [&](ObjectId id) {
    if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
    const Translation& past = task.pastOf(id);
    finder.beginObject({}, past);
    MeshPlacement atEnd = task.placement;
    for (size_t k = 0; k < 3; ++k) {
      const double shift = past.wayUntil(end) * past.unit[k];
      atEnd.origin[k] += shift;
      atEnd.error[k] += 32 * kUnit * (std::abs(atEnd.origin[k]) + std::abs(shift));
    }
    Piece own = back;
    own.unit = scaled(-1, past.unit);
    own.rate = past.rate;
    searchObject(task, id, atEnd, own, query.clearance, finder);
  });
  Result last = finder.answer();
  task.course.toQuery(last);
  if (last.status == Status::hit) last.t = last.hi;
  return last;
}

Closest QuerySearch::closestApproach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                                     std::span<const ObjectId> skipped, const Result& first) {
  // Whether surfaces meet is decided exactly.
  Result meeting = first;
  if (first.status != Status::clear && (query.clearance > 0 || query.anyHit)) {
    Query exactly = query;
    exactly.clearance = 0;
    exactly.anyHit = exactly.closest = exactly.exit = exactly.skipOverlapping = false;
    exactly.hits = 1;
    exactly.exclude.insert(exactly.exclude.end(), skipped.begin(), skipped.end());
    meeting = answer(exactly, scene, tree, nullptr, *stop_);
  }
  if (meeting.status != Status::clear) return {0, 0, meeting};
  Query near = query;
  near.ignoreLeaving = near.skipOverlapping = false;
  const Task task(near, scene);
  ClosestApproach finder;
  const PlacedMesh sensor{task.sensor, query.worldFromMesh, task.placement};
  nearest_.begin(sensor, finder, *stop_);
  const auto reach = [&](double least) {
    nearest_.advance(least, pairs_);
    if (least > finder.reach()) finder.skip(least);
    return finder.reach();
  };
  walkNear(Participants(query, scene), tree, task.motion, boxOf(task.sensor, query.worldFromMesh.m), reach,
           [&](ObjectId id) {
             if (std::binary_search(skipped.begin(), skipped.end(), id)) return;
             const Object& object = scene.objects[id].object;
             const Translation& past = task.pastOf(id);
             nearest_.add(id, scene.meshes[object.mesh], object.worldFromMesh, past, past, {}, {});
           });
  nearest_.advance(std::numeric_limits<double>::infinity(), pairs_);
  Closest closest = finder.answer();
  task.course.toQuery(closest.at);
  return closest;
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
    const auto reach = [&] { return reachOf(finder, part.piece); };
    walk(Participants(query, scene), tree, part.piece, start, reach, [&](ObjectId id) {
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
  if (lists != nullptr) *lists = {finder.nearest(), {skipped.begin(), skipped.end()}, {}, {}};
  if (first.status == Status::overlap && !query.ignoreLeaving) {
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
  const PairRule rule = task.ruleFor(id);
  finder.beginObject(rule, object.motion);
  const PlacedMesh sensor{task.sensor, task.query.worldFromMesh, task.placement};
  PathPair pair = pairOf(sensor, part, {mesh, object.worldFromMesh, placement}, id, object.motion, task.reach(rule));
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
      Participants(still, scene), tree, task.motion, roomyBox(still, scene), [] { return 0.0; },
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
  const auto add = [&](ObjectId id, NearestAtStart& finder) {
    const Object& object = scene.objects[id].object;
    const PairRule rule = task.ruleFor(id);
    const Translation motion = task.course.past(id);
    finder.allowFor(rule);
    nearest_.add(id, scene.meshes[object.mesh], object.worldFromMesh, motion, kAtRest, rule,
                 query.ignoreLeaving ? rule.leadOf(motion) : Lead{});
  };
  nearest_.begin(sensor, nearest, *stop_);
  walkNear(
      Participants(query, scene), tree, kAtRest, roomyBox(query, scene), [](double) { return 0.0; },
      [&](ObjectId id) {
        if (!std::binary_search(skipped.begin(), skipped.end(), id)) add(id, nearest);
      });
  nearest_.advance(std::numeric_limits<double>::infinity(), pairs_);
  nearest.describe(first);
  for (size_t i = 0; lists != nullptr && i < lists->hits.size(); ++i) {
    Result& hit = lists->hits[i];
    if (hit.status != Status::overlap) continue;
    if (hit.object == first.object) {
      nearest.describe(hit);
      continue;
    }
    NearestAtStart own(query);
    nearest_.begin(sensor, own, *stop_);
    add(hit.object, own);
    nearest_.advance(std::numeric_limits<double>::infinity(), pairs_);
    own.describe(hit);
  }
}

template <class Finder>
void QuerySearch::search(const Task& task, ObjectId id, Finder& finder) {
  const PairRule rule = task.ruleFor(id);
  const Translation& motion = task.pastOf(id);
  finder.beginObject(rule, motion);
  searchObject(task, id, task.placement, motion, task.reach(rule), finder);
}

void QuerySearch::searchObject(const Task& task, ObjectId id, const MeshPlacement& sensor, const Piece& piece,
                               double clearance, PairVisitor& visitor) {
  throwIfStopped(*stop_);
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  if (visitor.isBefore({id, mesh.tree.below[0].least, 0})) return;

  const gpu::MeshNode &rootA = task.sensor.tree.nodes[0], &rootB = mesh.tree.nodes[0];
  const MeshPlacement placement(mesh, object.worldFromMesh);
  const PairMotion pairMotion(sensor, placement, piece, clearance, visitor.latest());
  TimeSpan times;
  // The sensor's axes come first: they rule out most objects, and those of the object need a matrix inverse.
  const RelativePlacement fromSensor(task.axes, placement, pairMotion, -1);
  narrow(times, fromSensor, rootA, rootB);
  if (times.empty()) return;
  const RelativePlacement fromObject(MeshAxes(placement.linear), sensor, pairMotion, 1);
  narrow(times, fromObject, rootB, rootA);
  if (times.empty()) return;
  const MeshPair pair{{task.sensor, task.query.worldFromMesh, sensor},
                      {mesh, object.worldFromMesh, placement},
                      id,
                      pairMotion,
                      fromSensor,
                      fromObject};
  meshes_.run(pair, times.from, visitor, pairs_, *stop_);
}

template Result QuerySearch::answerOf(const Task& task, const FirstContact& finder, std::span<const ObjectId> skipped,
                                      Listed* lists);
template void QuerySearch::search(const Task& task, ObjectId id, FirstContact& finder);

}  // namespace radar::cpu
