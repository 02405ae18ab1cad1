// Errors: a failed VkResult becomes a radar::Error that names the call.
#pragma once

#include <cstdint>

#include <vulkan/vulkan_core.h>

#include "radar/scene.h"

namespace radar::gpu {

/// A scene or a batch is larger than the device's limits allow; no Vulkan call failed, and nothing was submitted.
class LimitError : public Error {
 public:
  using Error::Error;
};

const char* resultName(VkResult result);

/// Throws if `result` is an error, naming the call, and what it was for: "vkCreateBuffer (nodes, 64 bytes)". Makes text
/// for an error only: memory may run out between a call and what is to own the object that it made.
void check(VkResult result, const char* call, const char* about = nullptr, uint64_t size = 0,
           const char* unit = "bytes");

/// Whether a call failed for lack of memory, of the device or of the host.
bool isOutOfMemory(const Error& error);
bool isLost(const Error& error);  ///< the device

}  // namespace radar::gpu
