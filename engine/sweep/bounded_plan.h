// A query of the bounded tier becomes a plan: the clusters of both sides that can meet, placed in the window's pixels.
#pragma once

#include <optional>
#include <vector>

#include "shaders/interop.h"
#include "sweep/reach.h"

namespace radar {

struct BoundedPlan {
  gpu::View view{};                                ///< all but `firstPixel`
  std::vector<gpu::Draw> draws;                    ///< mesh and object only: the scene's by object, then the sensor
  std::vector<gpu::Item> items;                    ///< a cluster each, by draw
  std::vector<gpu::Band> sensorBands, sceneBands;  ///< all but where meshes and pixels begin; none: certainly clear
  /// Rows of a strip where a side is drawn by pixel, a band for each cluster; 0: by triangle, in bands of few pixels.
  uint32_t sensorStrip = 0, sceneStrip = 0;
  double pixel = 0;              ///< side of a pixel, world units
  std::array<Vector, 3> axes{};  ///< of the frame, world; the last along the motion
  Vector corner{};         ///< world position of the window's lower left corner at the depth of the frame's origin
  bool measurable = true;  ///< false: float cannot tell the scene's pixels apart; not to be drawn
  /// Of a row in the outer scopes.
  uint32_t pitch() const { return (view.width + gpu::kPixelGroup - 1) / gpu::kPixelGroup * gpu::kPixelGroup; }
  uint64_t pixels() const { return uint64_t{pitch()} * view.height; }
};

/// `resolution`: pixels of the window's longer side. `byPixel`: how both sides are drawn, as far as loops allow; where
/// it is not given, in the way that is cheaper by measurement. Either gives the same bits.
BoundedPlan planBounded(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, uint32_t resolution,
                        std::optional<bool> byPixel = {});

}  // namespace radar
