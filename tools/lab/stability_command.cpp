#include <filesystem>
#include <iostream>

#include "cyber_radar/progress.h"
#include "lab/commands.h"
#include "measure/stability.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  radar-lab stability --cases 2000 --resolution 16,64       under a minute
  radar-lab stability --out stability                       a page and tables of every family
  radar-lab stability --family thin --first 17 --cases 1    one case again
  radar-lab hard-cases --family thin --first 17 --out DIR   the case as a query file

Needles and plates edge-on, steep faces, exact touching, gaps of one rounding, 10^7 units from the origin, rings on
pegs, bodies at rest and the like: every tier is asked that offers what the query asks for, and each answer is compared
with the exact one. Exit status 1 if a promise is broken.)";

struct Options {
  StabilitySettings settings;
  std::string out;
  uint32_t device = kNone;
};

int stability(const Options& options) {
  const Device device = Device::open({.index = options.device});
  if (!options.out.empty()) makeFolder("--out", options.out);
  Json report = newReport("Cyber Radar: where methods fail", {{"device", device.name() + ", " + device.driver()}});
  bool right = false;
  {
    Progress progress("cases", options.settings.cases);
    right = measureStability(
        device, options.settings, report, [](const std::string& words) { std::cout << "WRONG: " << words << "\n"; },
        [&](uint64_t done) { progress.add(done); });
  }
  std::cout << "device " << device.name() << ", driver " << device.driver() << ", commit "
            << report["commit"].get<std::string>() << "\n"
            << textOf(partOf(report, "totals")["rows"]);
  if (!options.out.empty()) {
    writeReport(options.out, report);
    std::cout << "\nIn " << std::filesystem::absolute(options.out).string()
              << ": index.html, report.json, tables as .csv\n";
  }
  return right ? 0 : 1;
}

}  // namespace

void addStabilityCommand(Program& program) {
  Command command = program.add(
      "stability", "Holds every tier against the exact answer where collision queries are known to fail", kExamples);
  auto options = std::make_shared<Options>();
  StabilitySettings& settings = options->settings;
  command.option("--cases", &settings.cases, "In all, over the families alike").value("N").within(1, 1e9);
  command.option("--seed", &settings.seed, "Another seed, other cases").value("N");
  command.option("--resolution", &settings.resolutions, "Pixels of the scopes' longer side, with commas between")
      .list()
      .within(1, kMaxResolution)
      .value("N,...");
  command.option("--out", &options->out, "Folder for a page and tables of every family").value("DIR");
  command.option("--family", &settings.families, "Only these").oneOf(hardFamilyNames());
  command.option("--first", &settings.first, "Number of each family's first case").value("N");
  command.option("--device", &options->device, "Number of the device, as cyber-radar devices lists them").value("I");
  command.run([options] { return stability(*options); });
}

}  // namespace radar::tools
