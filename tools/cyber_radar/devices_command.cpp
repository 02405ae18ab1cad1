#include <iostream>

#include "cyber_radar/commands.h"
#include "radar/radar.h"

namespace radar::tools {

namespace {

int listAll() {
  const std::vector<DeviceReport> devices = listDevices();
  bool someUsable = false;
  for (size_t i = 0; i < devices.size(); ++i) {
    const DeviceReport& device = devices[i];
    someUsable = someUsable || device.usable();
    std::cout << i << "  " << device.name << " (" << device.type << ", " << device.driver
              << "): " << (device.usable() ? "usable" : "not usable") << "\n";
    for (const std::string& reason : device.reasons) std::cout << "     " << reason << "\n";
    if (!device.usable()) continue;
    for (const std::string& reason : device.sampledReasons) std::cout << "     no mode sampled: " << reason << "\n";
  }
  if (someUsable) return 0;
  std::cout << "No usable device. A software device: apt install mesa-vulkan-drivers\n";
  return kStatusBadInput;
}

}  // namespace

void addDevicesCommand(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("devices", "Lists every Vulkan device: usable, or why not; --device takes these numbers");
  command->callback([&status] { status = listAll(); });
}

}  // namespace radar::tools
