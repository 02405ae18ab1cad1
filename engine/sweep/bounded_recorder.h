// The recipe of the bounded tier: outer scopes, the lower bound, nominated pairs. Owns its pipelines and buffers.
#pragma once

#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "sweep/bounded_plan.h"
#include "sweep/resident_scene.h"
#include "sweep/sampled_recorder.h"

namespace radar {

/// Outer scopes of one view, row by row, depth along the motion from the frame's origin in pixels; NaN where there is
/// none.
struct StoredOuterScopes {
  std::vector<float> sensorNearest, sceneNearest, sceneFarthest, sensorFarthest;  ///< S, R, F, M
};

class BoundedRecorder {
 public:
  BoundedRecorder(const Device::Impl& device, ResidentScene& resident, bool timestamps);

  /// Bytes of device memory that the scopes of so many pixels take, in one buffer.
  static uint64_t scopeBytes(uint64_t pixels) { return 4 * pixels * sizeof(uint32_t); }

  /// Every plan is measurable and has bands on both sides. One upload, one command buffer, one readback. With `scopes`,
  /// those of every view come too. Adds each stage's time to `stages`.
  Answers submit(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene, std::vector<StageTime>& stages,
                 std::vector<StoredOuterScopes>* scopes = nullptr);

 private:
  struct DrawPipelines {
    gpu::Pipeline byTriangle, byPixel;
  };
  /// The bands of all views' scenes or sensors that are drawn by triangle, and the strips of those drawn by pixel.
  struct Side {
    uint32_t firstBand, bands, firstStrip, strips;
  };

  DrawPipelines drawPipelines(const char* name, uint32_t draws) const;
  Side listSide(std::span<const BoundedPlan* const> plans, bool isSensor);
  void listView(const BoundedPlan& plan, std::span<const gpu::Band> bands, uint32_t view, uint32_t firstItem,
                uint32_t stripRows);
  void stage(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene);
  void bind();
  void dispatchEach(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t first, uint32_t count) const;
  void draw(const gpu::Commands& commands, const DrawPipelines& pipelines, const Side& side) const;
  std::vector<StoredOuterScopes> scopesOf(std::span<const BoundedPlan* const> plans, const std::byte* stored) const;

  const Device::Impl* device_;
  ResidentScene& resident_;
  gpu::Upload upload_;
  gpu::Submission submission_;
  gpu::Bindings bindings_;
  DrawPipelines drawFarthest_, drawSensor_, drawNearest_;
  gpu::Pipeline reduce_, identify_, solve_;
  gpu::Buffer views_, draws_, items_, bands_, strips_, scopes_, candidates_, ranks_, answers_, openPairs_, readback_;
  std::vector<gpu::View> viewList_;
  std::vector<gpu::Draw> drawList_;
  std::vector<gpu::Item> itemList_;
  std::vector<gpu::Band> bandList_;
  std::vector<gpu::Strip> stripList_;
  Side scene_{}, sensor_{};
  uint32_t plane_ = 0;  ///< pixels of all views
};

}  // namespace radar
