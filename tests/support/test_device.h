// The device that the tests share, and the messages of the validation layers.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "radar/radar.h"

namespace radar::test {

/// Whether the device may use doubles: not if the environment variable RADAR_TEST_DOUBLES is "off".
bool wantsDoubles();
/// Opened on first use. Messages of the validation layers go to onValidation().
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
