// Errors: a failed VkResult becomes a radar::Error that names the call.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

#include "radar/scene.h"

namespace radar::gpu {

/// A scene or a batch is larger than the device's limits allow; no Vulkan call failed, and nothing was submitted.
class LimitError : public Error {
 public:
  using Error::Error;
};

const char* resultName(VkResult result);

/// Throws if `result` is an error. `call` names the call and the size requested, if any.
void check(VkResult result, const std::string& call);

/// Whether a call failed for lack of memory, of the device or of the host.
bool isOutOfMemory(const Error& error);

}  // namespace radar::gpu
