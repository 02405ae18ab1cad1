// Queries of the contact tier become what its passes read.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// The queries of one submission that are searched on the device.
struct SensorBatch {
  std::vector<gpu::Sensor> sensors;  ///< Placement::root is left open: it depends on the device's copy of the scene
  std::vector<gpu::Sweep> sweeps;
  std::vector<uint32_t> excluded;

  uint32_t count() const { return static_cast<uint32_t>(sensors.size()); }
  void clear();
};

enum class Planned {
  added,
  clear,      ///< there is nothing to meet
  outOfRange  ///< floats cannot hold it: the sensor, the scene, the distance, or how large one is beside the other
};

/// Adds a query, which keeps its contract; its answer goes to place `result`.
Planned addSensor(SensorBatch& batch, const Query& query, uint32_t result, const Scene::Impl& scene,
                  const ObjectTree& tree);

}  // namespace radar
