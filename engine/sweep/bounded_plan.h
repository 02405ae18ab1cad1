// A query of the bounded tier becomes a plan: the clusters of both sides that can meet, placed in the window's pixels.
#pragma once

#include <vector>

#include "shaders/interop.h"
#include "sweep/reach.h"

namespace radar {

struct BoundedPlan {
  gpu::View view{};                                ///< all but `firstPixel`
  std::vector<gpu::Draw> draws;                    ///< mesh and object only: the scene's by object, then the sensor
  std::vector<gpu::Item> items;                    ///< a cluster each, by draw
  std::vector<gpu::Band> sensorBands, sceneBands;  ///< all but where meshes and pixels begin; none: certainly clear
  double pixel = 0;                                ///< side of a pixel, world units
  bool measurable = true;  ///< false: float cannot tell the scene's pixels apart; not to be drawn
  uint64_t pixels() const { return uint64_t{view.width} * view.height; }
};

/// `resolution`: pixels of the window's longer side.
BoundedPlan planBounded(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, uint32_t resolution);

}  // namespace radar
