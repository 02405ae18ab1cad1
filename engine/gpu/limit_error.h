#pragma once

#include "radar/scene.h"

namespace radar::gpu {

/// A scene or a batch is larger than the device's limits allow; no Vulkan call failed, and nothing was submitted.
class LimitError : public Error {
 public:
  using Error::Error;
};

}  // namespace radar::gpu
