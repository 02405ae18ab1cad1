// The device that the tests share, and what the validation layers said about it.
#pragma once

#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::test {

/// The environment variable RADAR_TEST_DOUBLES, "off" or not set: whether the device shall use doubles.
bool wantsDoubles();
/// Opened on first use, with the validation layers listening.
const Device& device();

/// Where other devices' DeviceOptions::onValidation should send their messages too.
void onValidation(const std::string& message);

/// Messages since the last call.
std::vector<std::string> takeValidationMessages();

}  // namespace radar::test
