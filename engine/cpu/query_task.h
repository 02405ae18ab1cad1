// A query, prepared for the search past any object.
#pragma once

#include <algorithm>
#include <optional>

#include "cpu/query_search.h"

namespace radar::cpu {

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

}  // namespace radar::cpu
