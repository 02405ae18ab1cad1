#include "support/test_device.h"

#include <cstdlib>
#include <mutex>
#include <utility>

namespace radar::test {

namespace {

std::mutex mutex;
std::vector<std::string> messages;

}  // namespace

void onValidation(const std::string& message) {
  const std::lock_guard lock(mutex);
  messages.push_back(message);
}

std::vector<std::string> takeValidationMessages() {
  const std::lock_guard lock(mutex);
  return std::exchange(messages, {});
}

bool wantsDoubles() {
  const char* setting = std::getenv("RADAR_TEST_DOUBLES");
  return setting == nullptr || std::string(setting) != "off";
}

const Device& device() {
  static const Device opened = Device::open({.onValidation = onValidation, .doubles = wantsDoubles()});
  return opened;
}

}  // namespace radar::test
