// States the searches of queries for the device, which encodes them (shaders/contact/encode.comp.glsl).
#pragma once

#include <vector>

#include "exact/motion.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// The queries of one submission that are searched on the device.
struct SensorBatch {
  std::vector<gpu::StatedSearch> stated;
  std::vector<gpu::Sweep> sweeps;
  std::vector<uint32_t> excluded;

  uint32_t count() const { return static_cast<uint32_t>(stated.size()); }
  void clear();
  /// Forgets all but the first `count` queries.
  void truncate(uint32_t count);
};

enum class Planned {
  added,
  clear,      ///< nothing is in reach
  outOfRange  ///< floats cannot hold the scene or the direction; for the rest, the device finds out
};

/// A query's search in double precision, but for what depends on a scale. `motion`: the query's; `direction`: that of
/// the motion, by scaledDirection(). `result`: the index of its answer.
gpu::Sweep sweepOf(const Query& query, const Motion& motion, const Vector& direction, uint32_t result);

/// Adds a valid query; its answer gets the index `result`. `object`: the only one to search, or kNone: all, if none
/// moves. Times of a step are fractions.
Planned addSensor(SensorBatch& batch, const Query& query, uint32_t result, const Scene::Impl& scene,
                  const ObjectTree& tree, ObjectId object = kNone);

}  // namespace radar
