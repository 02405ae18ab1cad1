// The recipe of a sweep: owns pipelines, buffers and pictures, and records a batch. The only file that puts barriers
// between stages.
#pragma once

#include <map>

#include "gpu/depth_array.h"
#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "sweep/batch.h"
#include "sweep/resident_scene.h"

namespace radar {

/// What the shaders say of a batch, by view; open pairs: kOpenPairs per view. Valid until the next submission.
struct Answers {
  std::span<const gpu::Answer> answers;
  std::span<const gpu::OpenPair> openPairs;
};

/// Depth of one view, as stored: 0 near, 1 empty.
struct StoredScopes {
  std::vector<float> range, mask;
};

/// Solves nominated pairs, with doubles where the device has them.
std::span<const uint32_t> solveShader(const Device::Impl& device);

class SampledRecorder {
 public:
  /// `resident`: the scene's copy, shared with other recorders of the device.
  SampledRecorder(const Device::Impl& device, ResidentScene& resident, uint64_t pictureBytes, bool timestamps);

  /// Uploads what changed in the scene, and nothing else.
  void sync(const Scene::Impl& scene);
  /// One upload, one command buffer, one readback; returns while the device works on it, and collect() comes next, with
  /// the same arguments. With `scopes`, the pictures of view 0 come too.
  void submit(const Batch& batch, const Scene::Impl& scene, bool scopes = false);
  /// Waits for what was submitted, and adds each stage's time to `stages`.
  Answers collect(const Batch& batch, const Scene::Impl& scene, std::vector<StageTime>& stages,
                  StoredScopes* scopes = nullptr);

 private:
  struct Pictures {
    gpu::DepthArray range, mask;
  };

  /// Bytes of each part.
  struct Readback {
    VkDeviceSize answers, openPairs, picture;
  };

  static Readback readbackOf(const Batch& batch, bool scopes);
  Pictures& picturesFor(const Batch& batch);
  void stage(const Batch& batch, const Scene::Impl& scene);
  void bind(const Pictures& pictures);
  void drawScopes(const gpu::Commands& commands, const Batch& batch, const std::vector<DepthPass>& passes,
                  gpu::DepthArray& target) const;

  const Device::Impl* device_;
  uint64_t pictureBytes_;
  ResidentScene& resident_;
  gpu::Upload upload_;
  gpu::Submission submission_;
  gpu::Bindings bindings_;
  gpu::RenderPass renderPass_;
  gpu::Sampler sampler_;
  gpu::Pipeline depth_, reduce_, identify_, solve_;
  gpu::Buffer views_, draws_, items_, candidates_, ranks_, answers_, openPairs_, readback_;
  std::map<uint32_t, Pictures> pictures_;  ///< by side
};

}  // namespace radar
