// Packs plans for one submission.
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
  std::vector<gpu::Sweep> sweeps;  ///< by view
  std::vector<gpu::Draw> draws;
  std::vector<gpu::Item> items;
  std::vector<DrawCall> calls;
  std::vector<DepthPass> rangePasses, maskPasses;
  uint32_t layers = 0;      ///< one per view
  uint32_t resolution = 0;  ///< the greatest
  uint64_t triangles = 0;
  uint64_t objects = 0;  ///< objects drawn for R
};

/// `plans`: in ascending resolution, each with at least one object in reach. Plan i becomes view i, in layer i.
/// `passTriangles`: of a render pass, about as many as it draws; it has one layer at least.
SampledBatch packBatch(std::span<const ViewPlan* const> plans, uint32_t passTriangles);

}  // namespace radar
