#include "scene/scene_copy.h"

namespace radar {

SceneCopy::SceneCopy(const Device& device, const Scene& scene)
    : impl_(new Impl{device.impl(), scene, std::make_shared<GpuScene>(device.impl())}) {}
SceneCopy::~SceneCopy() = default;
SceneCopy::SceneCopy(SceneCopy&&) noexcept = default;
SceneCopy& SceneCopy::operator=(SceneCopy&&) noexcept = default;
uint64_t SceneCopy::memoryUse() const {
  return impl_->copy->memoryUse();
}

}  // namespace radar
