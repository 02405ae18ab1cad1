#include "support/test_device.h"

#include <cstdlib>
#include <mutex>
#include <utility>

namespace radar::test {

namespace {

std::mutex mutex;
std::vector<std::string> messages;
std::vector<std::function<void()>> ends;

}  // namespace

void onValidation(const std::string& message) {
  // Layers since 1.4.309 say so of every draw that writes the layer, though it writes 0 and there is one.
  if (message.starts_with("Undefined-Value-Layer-Written")) return;
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
  return onceInRun([] { return Device::open({.onValidation = onValidation, .doubles = wantsDoubles()}); });
}

void atEndOfRun(std::function<void()> end) {
  ends.push_back(std::move(end));
}

void endRun() {
  for (; !ends.empty(); ends.pop_back()) ends.back()();
}

}  // namespace radar::test
