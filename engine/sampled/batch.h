// Plans become what one submission uploads and draws.
#pragma once

#include <span>
#include <vector>

#include "sampled/plan.h"

namespace radar {

/// One instanced draw: `count` instances of a run of a mesh, from `firstDraw`.
struct DrawCall {
  MeshId mesh;
  Run run;
  uint32_t firstDraw, count;
};

/// One render pass: consecutive layers of one resolution.
struct DepthPass {
  uint32_t firstLayer, layers, resolution;
  uint32_t firstCall, calls;
};

struct SampledBatch {
  std::vector<gpu::View> views;
  std::vector<gpu::Draw> draws;
  std::vector<gpu::Item> items;
  std::vector<DrawCall> calls;
  std::vector<DepthPass> rangePasses, maskPasses;
  uint32_t layers = 0;      ///< one a view
  uint32_t resolution = 0;  ///< the greatest
  uint64_t triangles = 0;
  uint64_t objects = 0;  ///< drawn for R

  void clear();
};

/// `plans`: ascending by resolution, each with something in reach. View i is plan i, in layer i.
void packBatch(SampledBatch& batch, std::span<const ViewPlan* const> plans);

}  // namespace radar
