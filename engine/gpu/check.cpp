#include "gpu/check.h"

namespace radar::gpu {

const char* resultName(VkResult result) {
  switch (result) {
#define RADAR_CASE(name) \
  case name:             \
    return #name;
    RADAR_CASE(VK_SUCCESS)
    RADAR_CASE(VK_NOT_READY)
    RADAR_CASE(VK_TIMEOUT)
    RADAR_CASE(VK_INCOMPLETE)
    RADAR_CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
    RADAR_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
    RADAR_CASE(VK_ERROR_INITIALIZATION_FAILED)
    RADAR_CASE(VK_ERROR_DEVICE_LOST)
    RADAR_CASE(VK_ERROR_MEMORY_MAP_FAILED)
    RADAR_CASE(VK_ERROR_LAYER_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_FEATURE_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
    RADAR_CASE(VK_ERROR_TOO_MANY_OBJECTS)
    RADAR_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED)
    RADAR_CASE(VK_ERROR_FRAGMENTED_POOL)
    RADAR_CASE(VK_ERROR_OUT_OF_POOL_MEMORY)
#undef RADAR_CASE
    default:
      return "unknown VkResult";
  }
}

void check(VkResult result, const char* call, const char* about, uint64_t size, const char* unit) {
  if (result >= VK_SUCCESS) return;
  std::string text = call;
  if (about) text += std::string(" (") + about;
  if (size > 0) text += (about ? ", " : " (") + std::to_string(size) + " " + unit;
  if (about || size > 0) text += ")";
  throw Error(text + ": " + resultName(result) + " (" + std::to_string(result) + ")", result);
}

bool isOutOfMemory(const Error& error) {
  return error.vulkan == VK_ERROR_OUT_OF_HOST_MEMORY || error.vulkan == VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

bool isLost(const Error& error) {
  return error.vulkan == VK_ERROR_DEVICE_LOST;
}

}  // namespace radar::gpu
