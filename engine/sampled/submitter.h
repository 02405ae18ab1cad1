// Runs batches of mode sampled on the engine's queue. Owns the pictures and buffers.
#pragma once

#include <map>

#include "contact/pair_solver.h"
#include "gpu/depth_array.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "sampled/batch.h"
#include "scene/gpu_scene.h"

namespace radar {

/// The shaders' output, answers and contacts by view. Valid until the next submission.
struct SampledAnswers {
  std::span<const gpu::Answer> answers;
  std::span<const Result> contacts;  ///< the first among the proposed pairs, as in mode contact
  std::span<const gpu::UnresolvedPair> unresolved;
  uint32_t pairs;  ///< proposed
};

/// Depth of one view, as stored: 0 near, 1 empty.
struct StoredScopes {
  std::vector<float> range, mask;
};

class SampledSubmitter {
 public:
  /// `resident`: the scene's copy, shared by users of the device.
  SampledSubmitter(const gpu::Owner& owner, GpuScene& resident, uint64_t pictureBytes, bool timestamps);

  /// Submits one upload, one command buffer and one readback without waiting; call collect() next, with the same
  /// batch. `scopes`: also reads back the pictures of view 0. If this throws, the memory of all pictures is free.
  void submit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes = false);
  /// Waits for the submission, and adds each stage's time to `stages`.
  SampledAnswers collect(const SampledBatch& batch, std::vector<StageTime>& stages, StoredScopes* scopes = nullptr);

 private:
  struct Pictures {
    gpu::DepthArray range, mask;
  };

  /// Where the parts of the readback begin: the counts of pairs, contacts, answers, two pictures; and where it ends.
  struct Readback {
    VkDeviceSize contacts, answers, range, mask, end;
  };

  static Readback readbackOf(const SampledBatch& batch, bool scopes);
  void recordAndSubmit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes);
  Pictures& picturesFor(const SampledBatch& batch);
  void stage(const SampledBatch& batch, const Scene::Impl& scene);
  void record(const gpu::Commands& commands, const SampledBatch& batch, Pictures& pictures);
  void drawScopes(const gpu::Commands& commands, const SampledBatch& batch, const std::vector<DepthPass>& passes,
                  gpu::DepthArray& target) const;

  gpu::Owner owner_;
  uint64_t pictureBytes_;
  GpuScene& resident_;
  gpu::Upload upload_;
  gpu::Submission submission_;
  gpu::Passes run_;
  PairSolver solver_;
  gpu::RenderPass renderPass_;
  gpu::Sampler sampler_;
  gpu::Array<gpu::View> views_;
  gpu::Array<gpu::Draw> draws_;
  gpu::Array<gpu::Item> items_;
  gpu::Array<gpu::Candidate> candidates_;
  gpu::Array<uint32_t> ranks_;
  gpu::Array<gpu::Answer> answers_;
  gpu::Buffer readback_;
  GpuScene::Staged staged_;
  std::map<uint32_t, Pictures> pictures_;  ///< by side
};

}  // namespace radar
