// The device that the tests share, and the messages of the validation layers.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "radar/radar.h"

namespace radar::test {

/// Whether a device of this name is one that the tests are of: its name contains the environment variable
/// RADAR_TEST_DEVICE, such as "H200"; without the variable, "llvmpipe".
bool isTested(const std::string& name);
/// Their numbers in listDevices(). Throws Error with all names if there is none.
const std::vector<uint32_t>& testedDevices();
/// Whether the first is lavapipe. What is true of it alone is checked on it alone.
bool isLavapipe();
/// Whether the validation layers have to report hazards. Always if RADAR_TEST_DEVICE is not set, so that nothing is
/// skipped unasked, unless they are GPU-assisted; else if VK_INSTANCE_LAYERS names them. If not, says so on standard
/// error.
bool isValidated();
/// Whether the device has doubles and may use them: not if the environment variable RADAR_TEST_DOUBLES is "off".
bool wantsDoubles();
/// Of the first tested device, without debug names and labels; messages of the validation layers go to onValidation().
DeviceOptions deviceOptions();
/// So opened on first use; said to be a GPU if the environment variable RADAR_TEST_KIND is "gpu".
const Device& device();

/// Collects a message, which begins with its name. Other devices use it as their DeviceOptions::onValidation.
void onValidation(const std::string& message);

/// The messages since the last call.
std::vector<std::string> takeValidationMessages();

/// A Device ends before main() does (radar/device.h), and so does what uses one: endRun() calls these, last first.
void atEndOfRun(std::function<void()> end);
void endRun();
/// What `make` returns, made by the first call and destroyed by endRun().
template <class Make>
auto& onceInRun(const Make& make) {
  using Object = decltype(make());
  static Object* object = nullptr;
  if (object == nullptr) {
    object = new Object(make());
    atEndOfRun([] { delete std::exchange(object, nullptr); });
  }
  return *object;
}

}  // namespace radar::test
