// A sensor that turns, and all objects, at any time of the step: exact tests of poses that long doubles place.
#pragma once

#include <algorithm>
#include <cmath>

#include "radar/query.h"
#include "scene/scene.h"
#include "support/shape.h"

namespace radar::test {

inline Shape placed(const Mesh& mesh, const Transform& pose, const auto& move) {
  Shape out;
  for (uint32_t i = 0; i < mesh.triangleCount(); ++i) {
    exact::Triangle corners = placedTriangle(mesh, pose, i);
    for (Vector& corner : corners) corner = move(corner);
    out.add(corners);
  }
  return out;
}

// As the question is stated.
inline Vector turned(const Query& query, const Vector& p, double s) {
  using Real = long double;
  const Turn& turn = *query.turn;
  const Vector way = query.motion.value_or(Vector{});
  Real axis[3], r[3];
  const Real length = std::sqrt(Real(turn.axis[0]) * turn.axis[0] + Real(turn.axis[1]) * turn.axis[1] +
                                Real(turn.axis[2]) * turn.axis[2]);
  for (int k = 0; k < 3; ++k) {
    axis[k] = turn.axis[k] / length;
    r[k] = Real(p[k]) - turn.centre[k];
  }
  const Real angle = Real(s) * turn.angle, along = axis[0] * r[0] + axis[1] * r[1] + axis[2] * r[2];
  const Real sine = std::sin(angle), cosine = std::cos(angle);
  Vector out;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real across = axis[i] * r[j] - axis[j] * r[i];
    out[k] = double(turn.centre[k] + Real(s) * way[k] + cosine * r[k] + sine * across + (1 - cosine) * along * axis[k]);
  }
  return out;
}

/// A query's sensor and all objects, at any time of the step.
class TurnTruth {
 public:
  TurnTruth(const Query& query, const Scene& scene) : query_(query), scene_(scene.impl()) {}

  /// Whether surfaces cross by more than `slack`; with a clearance, whether they are nearer than that less `slack`.
  bool meet(double s, double slack) const {
    const Shape sensor =
        placed(scene_.meshes[query_.mesh], query_.worldFromMesh, [&](const Vector& p) { return turned(query_, p, s); });
    for (ObjectId id = 0; id < scene_.objects.size(); ++id) {
      const Scene::Impl::ObjectSlot& slot = scene_.objects[id];
      const bool takesPart = (slot.object.mask & query_.mask) != 0 && std::ranges::count(query_.exclude, id) == 0;
      if (!slot.used || !takesPart) continue;
      const auto move = [&](const Vector& p) { return along(p, s, slot.object.motion); };
      const Shape other = placed(scene_.meshes[slot.object.mesh], slot.object.worldFromMesh, move);
      if (test::meet(sensor, other, query_.clearance, slack)) return true;
    }
    return false;
  }

 private:
  const Query& query_;
  const Scene::Impl& scene_;
};

}  // namespace radar::test
