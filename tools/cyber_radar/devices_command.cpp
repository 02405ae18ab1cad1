#include <algorithm>
#include <iostream>

#include "cyber_radar/commands.h"
#include "measure/selftest.h"

namespace radar::tools {

namespace {

constexpr const char* kNoneUsable = "No usable device. A software device: apt install mesa-vulkan-drivers\n";

void list(const std::vector<DeviceReport>& devices) {
  for (size_t i = 0; i < devices.size(); ++i) {
    const DeviceReport& device = devices[i];
    std::cout << i << "  " << device.name << " (" << device.type << ", " << device.driver
              << "): " << (device.usable() ? "usable" : "not usable") << "\n";
    for (const std::string& reason : device.reasons) std::cout << "     " << reason << "\n";
    if (!device.usable()) continue;
    for (const std::string& reason : device.sampledReasons) std::cout << "     no mode sampled: " << reason << "\n";
  }
}

int listAll(bool json) {
  const std::vector<DeviceReport> devices = listDevices();
  if (json) {
    Json all = Json::array();
    for (uint32_t i = 0; i < devices.size(); ++i) all.push_back(factsOf(i, devices[i]));
    std::cout << all.dump(2) << "\n";
  } else {
    list(devices);
  }
  if (std::any_of(devices.begin(), devices.end(), [](const DeviceReport& device) { return device.usable(); })) return 0;
  (json ? std::cerr : std::cout) << kNoneUsable;
  return kStatusBadInput;
}

}  // namespace

void addDevicesCommand(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("devices", "Lists every Vulkan device: usable, or why not; --device takes these numbers");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Prints all that is known of them as one JSON array");
  command->callback([json, &status] { status = listAll(*json); });
}

}  // namespace radar::tools
