// The device that the tests share, and the messages of the validation layers.
#pragma once

#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::test {

/// Whether the device may use doubles: not if the environment variable RADAR_TEST_DOUBLES is "off".
bool wantsDoubles();
/// Opened on first use. Messages of the validation layers go to onValidation().
const Device& device();

/// Collects a message. Other devices use it as their DeviceOptions::onValidation.
void onValidation(const std::string& message);

/// The messages since the last call.
std::vector<std::string> takeValidationMessages();

}  // namespace radar::test
