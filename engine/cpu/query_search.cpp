#include "cpu/query_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "cpu/clearance.h"
#include "cpu/closest_approach.h"
#include "cpu/last_contact.h"
#include "query/hits.h"
#include "query/near_walk.h"

namespace radar::cpu {

namespace {

const Piece kAtRest;
constexpr size_t kCacheLine = 64;

template <bool toWrite, class Value>
void prefetch(const Value& value) {
  const char* const bytes = reinterpret_cast<const char*>(&value);
  for (size_t at = 0; at < sizeof(Value); at += kCacheLine) __builtin_prefetch(bytes + at, toWrite ? 1 : 0);
}

}  // namespace

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

  /// The motion past an object; stays in place until the next one.
  const Translation& pastOf(ObjectId id) const { return course.isStep() ? past_.emplace(course.past(id)) : motion; }
  /// How pairs with an object are judged. Computed only if the query needs it.
  PairRule ruleFor(ObjectId id) const {
    if (!query.ignoreLeaving && !query.skipOverlapping) return {};
    const Object& object = scene.objects[id].object;
    const double farthest = placedMagnitude(scene.meshes[object.mesh].farthest, object.worldFromMesh);
    const double slack = query.slack ? *query.slack : exact::defaultSlack(std::max(magnitude, farthest));
    return {slack, {mirrored, exact::isMirroring(object.worldFromMesh)}};
  }
  /// How near pairs matter. Faces that are pressed together may have passed each other by the slack.
  double reach(const PairRule& rule) const {
    return std::max(query.clearance, query.ignoreLeaving ? 2 * rule.slack : 0);
  }

 private:
  mutable std::optional<Translation> past_;
};

/// A query without a clearance whose answer is under way.
struct QuerySearch::Flight {
  size_t place;  ///< in the batch
  Task task;
  Participants participants;
  FirstContact finder;
  double reach;
  Walk walk;
  ObjectId object = kNone;  ///< that the walk has reached

  Flight(const Batch& batch, size_t i, FlightMemory& memory)
      : place(i),
        task(batch.queries[i], batch.scene),
        participants(task.query, task.scene),
        finder(task.query, task.motion, std::move(memory.touching)),
        reach(reachOf(finder, task.motion)),
        walk(task.scene, batch.tree, task.motion, roomyBox(task.query, task.scene), reach, memory.open) {}

  /// Whether a query can take turns with others on one thread.
  static bool canAnswer(const Query& query, const Batch& batch) {
    return query.clearance == 0 && !hasLists(query) && !turns(query) && Participants::areFew(query) &&
           batch.scene.meshes[query.mesh].parts.empty() && batch.tree.inRange();
  }
  /// Takes a step of the walk. Returns whether it goes on, since it has not reached an object yet.
  bool step() {
    object = walk.step(reach);
    if (object != kNone && !participants.contain(object)) object = kNone;
    return object == kNone && !walk.isOver();
  }
};

void QuerySearch::answer(const Batch& batch, size_t first, size_t last) {
  stop_ = &batch.stop;
  const auto placeOf = [&](size_t at) { return batch.order.empty() ? at : batch.order[at]; };
  const auto answerAlone = [&](size_t i) {
    const Query& query = batch.queries[i];
    Listed* const listed = hasLists(query) ? &batch.lists[i] : nullptr;
    batch.results[i] = answer(query, batch.scene, batch.tree, listed, batch.stop);
    batch.results[i].tier = batch.tier;
    if (listed == nullptr) return;
    for (Result& hit : listed->hits) hit.tier = batch.tier;
    if (listed->closest) listed->closest->at.tier = batch.tier;
    if (listed->exit) listed->exit->tier = batch.tier;
  };
  // Pointers, since GCC fills an array of empty optionals with zeros.
  alignas(Flight) std::byte places[kFlights][sizeof(Flight)];
  struct Destroy {
    void operator()(Flight* flight) const { std::destroy_at(flight); }
  };
  std::array<std::unique_ptr<Flight, Destroy>, kFlights> flights;
  const auto begin = [&](size_t slot) {
    while (first < last && !flights[slot]) {
      throwIfStopped(batch.stop);
      const size_t i = placeOf(first);
      if (++first < last) prefetch<false>(batch.queries[placeOf(first)]);
      prefetch<true>(batch.results[i]);
      if (Flight::canAnswer(batch.queries[i], batch)) {
        flights[slot].reset(new (places[slot]) Flight(batch, i, memory_[slot]));
      } else {
        answerAlone(i);
      }
    }
    return flights[slot] != nullptr;
  };
  for (bool isUnderWay = true; isUnderWay;) {
    isUnderWay = false;
    std::array<Flight*, kFlights> walking;
    size_t count = 0;
    for (size_t slot = 0; slot < kFlights; ++slot) {
      if (!begin(slot)) continue;
      isUnderWay = true;
      walking[count++] = flights[slot].get();
    }
    while (count > 0) {
      for (size_t i = 0; i < count;) {
        if (walking[i]->step()) {
          ++i;
        } else {
          walking[i] = walking[--count];
        }
      }
    }
    for (size_t slot = 0; slot < kFlights; ++slot) {
      std::unique_ptr<Flight, Destroy>& flight = flights[slot];
      if (!flight) continue;
      if (flight->object != kNone) {
        search(flight->task, flight->object, flight->finder);
        flight->reach = reachOf(flight->finder, flight->task.motion);
      } else {
        Result& result = batch.results[flight->place];
        result = answerOf(flight->task, flight->finder, {}, nullptr);
        result.tier = batch.tier;
        memory_[slot].touching = flight->finder.giveBack();
        flight.reset();
      }
    }
  }
}

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

}  // namespace radar::cpu
