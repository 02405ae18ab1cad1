// Turns a failed VkResult into a radar::Error that names the call.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

#include "radar/scene.h"

namespace radar::gpu {

const char* resultName(VkResult result);

/// Throws if `result` is an error. `call` names the call and the size requested, if any.
void check(VkResult result, const std::string& call);

/// Whether a call failed for lack of memory, of the device or of the host.
bool isOutOfMemory(const Error& error);

}  // namespace radar::gpu
