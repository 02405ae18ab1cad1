// A square 2D-array depth image, one layer per sensor, drawn by a classic render pass and then sampled. With dynamic
// rendering the validation layer would not see hazards between depth writes and sampling.
#pragma once

#include <map>

#include "gpu/device.h"
#include "gpu/memory.h"
#include "gpu/shader.h"

namespace radar::gpu {

/// Clears to 1, stores, and leaves SHADER_READ_ONLY layout. Waits for compute shaders that still read the image, and
/// makes the depth available to later ones.
RenderPass depthRenderPass(const Device::Impl& device);

/// Nearest, clamped, for exact texels and gathers.
Sampler texelSampler(const Device::Impl& device);

/// Draws into it: chooses layers where the device can.
const Shader& depthShader(const Device::Impl& device);

class DepthArray {
 public:
  /// `side` x `side` pixels of D32, `layers` layers.
  DepthArray(const Owner& owner, const char* name, VkRenderPass renderPass, uint32_t side, uint32_t layers);

  /// All layers, for sampling.
  VkImageView view() const { return view_.get(); }
  /// A newIdentity() of the view.
  uint64_t identity() const { return identity_; }
  uint32_t layers() const { return layers_; }

  /// Call before the passes of a submission, while none is pending. Puts all layers in SHADER_READ_ONLY layout if they
  /// are not, since a batch may draw only some of them.
  void recordFirstUse(const Commands& commands);
  /// Begins the render pass on `count` layers from `first`, over `side` x `side` pixels from the corner. Each distinct
  /// range of layers keeps a framebuffer, so use few.
  void beginPass(const Commands& commands, uint32_t first, uint32_t count, uint32_t side);
  /// Copies the corner of a layer that compute shaders have read, `width` x `height` floats, to byte `offset` of
  /// `target`. All layers lose their contents.
  void recordCopy(const Commands& commands, uint32_t layer, uint32_t width, uint32_t height, VkBuffer target,
                  VkDeviceSize offset);

 private:
  struct Target {
    ImageView view;
    Framebuffer framebuffer;
  };

  const Device::Impl* device_;
  VkRenderPass renderPass_;
  uint32_t side_, layers_;
  Memory memory_;
  ImageHandle image_;
  ImageView view_;
  uint64_t identity_;
  std::map<std::pair<uint32_t, uint32_t>, Target> targets_;
  bool used_ = false;
};

}  // namespace radar::gpu
