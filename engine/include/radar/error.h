// Errors, and what a shared library exports.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// A symbol of the interface. On Windows a shared library is built with RADAR_EXPORTS, and used with RADAR_SHARED; its
// CMake targets set both.
#if !defined(_WIN32)
#define RADAR_API __attribute__((visibility("default")))
#elif defined(RADAR_EXPORTS)
#define RADAR_API __declspec(dllexport)
#elif defined(RADAR_SHARED)
#define RADAR_API __declspec(dllimport)
#else
#define RADAR_API
#endif

namespace radar {

/// The message names the call, the value and what was expected. `vulkan`: the VkResult of a failed Vulkan call, else 0
/// (VK_SUCCESS). `reasons`: why no device is usable, or what is wrong with one, line by line; else empty.
class RADAR_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, int32_t code = 0, std::vector<std::string> why = {})
      : std::runtime_error(what), vulkan(code), reasons(std::move(why)) {}
  int32_t vulkan;
  std::vector<std::string> reasons;
};

}  // namespace radar
