#pragma once

#include "radar/scene_copy.h"
#include "scene/gpu_scene.h"

namespace radar {

struct SceneCopy::Impl {
  const Device::Impl& device;
  const Scene& scene;
  std::shared_ptr<GpuScene> copy;
};

}  // namespace radar
