// A query of the contact tier becomes a plan: the clusters of both sides that can meet, placed in the sensor's frame.
#pragma once

#include <vector>

#include "shaders/interop.h"
#include "sweep/reach.h"

namespace radar {

struct ContactPlan {
  std::array<Vector, 3> axes{};            ///< of the sensor's frame, world; only where something is in reach
  Vector origin{};                         ///< of the frame, world
  gpu::Target target{};                    ///< all but where its pairs and contenders go
  std::vector<gpu::Placement> placements;  ///< the sensor's first
  std::vector<gpu::ClusterRef> sensor;     ///< placement: into `placements`
  std::vector<gpu::ClusterRef> scene;      ///< empty: certainly clear
  float hi = 0;  ///< nothing beyond counts, world units, rounded up: D, or what is certainly met
};

ContactPlan planContact(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy);

}  // namespace radar
