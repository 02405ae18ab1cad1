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

/// The message names the call, the value and what was expected.
class RADAR_API Error : public std::runtime_error {
 public:
  /// Where the mistake is.
  enum class Kind {
    call,     ///< a value that was passed, or the moment of the call, breaks the contract
    device,   ///< a device or driver is missing, lacks something, failed or is refused: another, or the CPU, may do
    internal  ///< what a device computed contradicts itself, or the engine does: please report it
  };
  /// Of a device, if a Vulkan call failed or there are reasons; else of the call.
  explicit Error(const std::string& what, int32_t code = 0, const std::vector<std::string>& why = {})
      : Error(code == 0 && why.empty() ? Kind::call : Kind::device, what, code, why) {}
  Error(Kind its, const std::string& what, int32_t code = 0, std::vector<std::string> why = {})
      : std::runtime_error(what), kind(its), vulkan(code), reasons(std::move(why)) {}
  Kind kind;
  int32_t vulkan;                    ///< the VkResult of a failed Vulkan call, else 0 (VK_SUCCESS)
  std::vector<std::string> reasons;  ///< why no device is usable, or what is wrong with one, line by line; else empty
};

}  // namespace radar
