#include "support/test_device.h"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "gpu/device.h"

namespace radar::test {

namespace {

std::mutex mutex;
std::vector<std::string> messages;
std::vector<std::function<void()>> ends;

constexpr const char* kLavapipe = "llvmpipe";

std::string settingOf(const char* variable, const char* without) {
  const char* setting = std::getenv(variable);
  return setting == nullptr ? without : setting;
}

const std::vector<DeviceReport>& reports() {
  static const std::vector<DeviceReport> kReports = listDevices();
  return kReports;
}

const DeviceReport& tested() {
  return reports()[testedDevices()[0]];
}

}  // namespace

void onValidation(const std::string& message) {
  // Layers since 1.4.309 say so of every draw that writes the layer, though it writes 0 and there is one.
  if (message.starts_with("Undefined-Value-Layer-Written")) return;
  // GPU-assisted ones tell so of each feature that they switch on for themselves, and that they are slow.
  if (message.starts_with("WARNING-GPU-Assisted-Validation") || message.starts_with("VALIDATION-SETTINGS")) return;
  const std::lock_guard lock(mutex);
  messages.push_back(message);
}

std::vector<std::string> takeValidationMessages() {
  const std::lock_guard lock(mutex);
  return std::exchange(messages, {});
}

bool isTested(const std::string& name) {
  return name.find(settingOf("RADAR_TEST_DEVICE", kLavapipe)) != std::string::npos;
}

const std::vector<uint32_t>& testedDevices() {
  static const std::vector<uint32_t> kNumbers = [] {
    std::vector<uint32_t> numbers;
    std::vector<std::string> names;
    for (const DeviceReport& report : reports()) {
      if (isTested(report.name)) numbers.push_back(static_cast<uint32_t>(names.size()));
      names.push_back(report.name);
    }
    if (numbers.empty()) {
      throw Error("no device's name contains " + settingOf("RADAR_TEST_DEVICE", kLavapipe), VK_SUCCESS, names);
    }
    return numbers;
  }();
  return kNumbers;
}

bool isLavapipe() {
  return tested().name.find(kLavapipe) != std::string::npos;
}

bool isValidated() {
  static const bool kIs = [] {
    const char* reason = nullptr;
    if (std::getenv("RADAR_TEST_DEVICE") != nullptr &&
        settingOf("VK_INSTANCE_LAYERS", "").find("VK_LAYER_KHRONOS_validation") == std::string::npos) {
      reason = "VK_INSTANCE_LAYERS does not name the validation layers";
    } else if (settingOf("VK_LAYER_ENABLES", "").find("GPU_ASSISTED") != std::string::npos) {
      reason = "they look for accesses beyond buffers instead";
    }
    if (reason != nullptr) std::fprintf(stderr, "not checked: that the layers report hazards, since %s\n", reason);
    return reason == nullptr;
  }();
  return kIs;
}

bool wantsDoubles() {
  return settingOf("RADAR_TEST_DOUBLES", "on") != "off" && tested().doubles;
}

DeviceOptions deviceOptions() {
  return {.index = testedDevices()[0], .onValidation = onValidation, .debugNames = false, .doubles = wantsDoubles()};
}

const Device& device() {
  return onceInRun([] {
    Device opened = Device::open(deviceOptions());
    if (settingOf("RADAR_TEST_KIND", "") == "gpu") {
      opened.impl().properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    }
    return opened;
  });
}

void atEndOfRun(std::function<void()> end) {
  ends.push_back(std::move(end));
}

void endRun() {
  for (; !ends.empty(); ends.pop_back()) ends.back()();
}

}  // namespace radar::test
