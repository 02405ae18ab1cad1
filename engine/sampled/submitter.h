// Records a batch of mode sampled: its pictures, its buffers, and the barriers between its stages.
#pragma once

#include <map>

#include "gpu/depth_array.h"
#include "gpu/kernel.h"
#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "sampled/batch.h"
#include "scene/gpu_scene.h"

namespace radar {

/// What the shaders say of a batch, by view; open pairs: kOpenPairs per view. Valid until the next submission.
struct SampledAnswers {
  std::span<const gpu::Answer> answers;
  std::span<const gpu::OpenPair> openPairs;
};

/// Depth of one view, as stored: 0 near, 1 empty.
struct StoredScopes {
  std::vector<float> range, mask;
};

class SampledSubmitter {
 public:
  /// `resident`: the scene's copy, shared with others of the device.
  SampledSubmitter(const Device::Impl& device, GpuScene& resident, uint64_t pictureBytes, bool timestamps);

  /// One upload, one command buffer, one readback; returns while the device works on it, and collect() comes next, with
  /// the same arguments. With `scopes`, the pictures of view 0 come too.
  void submit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes = false);
  /// Waits for what was submitted, and adds each stage's time to `stages`.
  SampledAnswers collect(const SampledBatch& batch, const Scene::Impl& scene, std::vector<StageTime>& stages,
                         StoredScopes* scopes = nullptr);

 private:
  struct Pictures {
    gpu::DepthArray range, mask;
  };

  /// Bytes of each part.
  struct Readback {
    VkDeviceSize answers, openPairs, picture;
  };

  static Readback readbackOf(const SampledBatch& batch, bool scopes);
  Pictures& picturesFor(const SampledBatch& batch);
  void stage(const SampledBatch& batch, const Scene::Impl& scene);
  void bind(const Pictures& pictures);
  void drawScopes(const gpu::Commands& commands, const SampledBatch& batch, const std::vector<DepthPass>& passes,
                  gpu::DepthArray& target) const;

  const Device::Impl* device_;
  uint64_t pictureBytes_;
  GpuScene& resident_;
  gpu::Upload upload_;
  gpu::Submission submission_;
  gpu::Bindings drawBindings_;  ///< of the depth passes
  gpu::RenderPass renderPass_;
  gpu::Sampler sampler_;
  gpu::Pipeline depth_;
  gpu::Array<gpu::View> views_;
  gpu::Array<gpu::Draw> draws_;
  gpu::Array<gpu::Item> items_;
  gpu::Array<gpu::Candidate> candidates_;
  gpu::Array<uint32_t> ranks_;
  gpu::Array<gpu::Answer> answers_;
  gpu::Array<gpu::OpenPair> openPairs_;
  gpu::Buffer readback_;
  gpu::KernelArguments reduce_, identify_, solve_;
  std::map<uint32_t, Pictures> pictures_;  ///< by side
};

}  // namespace radar
