#include <algorithm>
#include <array>
#include <iostream>

#include "cyber_radar/commands.h"
#include "measure/selftest.h"

namespace radar::tools {

namespace {

constexpr const char* kNoneUsable = "No usable device. A software device: apt install mesa-vulkan-drivers\n";

// What decides how many lanes of an AMD GPU are at work; other drivers have other words, which are all shown.
Json briefly(const Json& kernels) {
  const std::array wanted{"kernel",        "ms",        "Subgroups per SIMD", "VGPRs",
                          "Spilled VGPRs", "Code size", "LDS size",           "Scratch size"};
  const auto isIn = [&](const char* name) { return !kernels.empty() && kernels[0].contains(name); };
  if (!std::all_of(wanted.begin(), wanted.end(), isIn)) return kernels;
  Json rows = Json::array();
  for (const Json& kernel : kernels) {
    Json& row = rows.emplace_back(Json::object());
    for (const char* name : wanted) row[name] = kernel[name];
  }
  return rows;
}

void list(const std::vector<DeviceReport>& devices, const Json& facts) {
  for (size_t i = 0; i < devices.size(); ++i) {
    const DeviceReport& device = devices[i];
    std::cout << i << "  " << device.name << " (" << device.type << ", " << device.driver
              << "): " << (device.usable() ? "usable" : "not usable") << "\n";
    for (const std::string& reason : device.reasons) std::cout << "     " << reason << "\n";
    if (!device.usable()) continue;
    for (const std::string& reason : device.sampledReasons) std::cout << "     no mode sampled: " << reason << "\n";
    if (facts[i].contains("kernels")) std::cout << "\n" << textOf(briefly(facts[i]["kernels"]), "     ");
  }
}

// A row for each kernel, with a column for everything that the driver tells of one.
Json kernelsOf(uint32_t device) {
  const std::vector<KernelReport> kernels = compileKernels(device);
  Json row{{"kernel", ""}, {"ms", 0.0}}, rows = Json::array();
  for (const KernelReport& kernel : kernels) {
    for (const KernelReport::Statistic& statistic : kernel.statistics) row[statistic.name] = nullptr;
  }
  for (const KernelReport& kernel : kernels) {
    Json& own = rows.emplace_back(row);
    own["kernel"] = kernel.name;
    own["ms"] = kernel.milliseconds;
    for (const KernelReport::Statistic& statistic : kernel.statistics) own[statistic.name] = statistic.value;
  }
  return rows;
}

int listAll(bool json, bool kernels) {
  const std::vector<DeviceReport> devices = listDevices();
  Json all = Json::array();
  for (uint32_t i = 0; i < devices.size(); ++i) {
    all.push_back(factsOf(i, devices[i]));
    if (kernels && devices[i].usable()) all.back()["kernels"] = kernelsOf(i);
  }
  if (json) {
    std::cout << all.dump(2) << "\n";
  } else {
    list(devices, all);
  }
  if (std::any_of(devices.begin(), devices.end(), [](const DeviceReport& device) { return device.usable(); })) return 0;
  (json ? std::cerr : std::cout) << kNoneUsable;
  return kStatusBadInput;
}

}  // namespace

void addDevicesCommand(Program& program) {
  Command command =
      program.add("devices", "Lists every Vulkan device: usable, or why not; --device takes these numbers");
  auto json = std::make_shared<bool>(false), kernels = std::make_shared<bool>(false);
  command.option("--json", json.get(), "Prints all that is known of them as one JSON array");
  command.option("--kernels", kernels.get(),
                 "Compiles every kernel for the usable ones, and prints what their compilers tell: registers, spills, "
                 "code; each driver has its own words");
  command.run([json, kernels] { return listAll(*json, *kernels); });
}

}  // namespace radar::tools
