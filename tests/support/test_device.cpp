#include "support/test_device.h"

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

const Device& device() {
  static const Device opened = Device::open({.onValidation = onValidation});
  return opened;
}

}  // namespace radar::test
