#include <filesystem>
#include <iostream>

#include "cyber_radar/commands.h"
#include "cyber_radar/progress.h"
#include "measure/stability.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar stability --cases 2000 --resolution 16,64     under a minute
  cyber-radar stability --out stability                     a page and tables of every family
  cyber-radar stability --family thin --first 17 --cases 1  one case again
  cyber-radar workload hard --family thin --first 17 --out DIR
                                                            the case as a query file

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

void addStabilityCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "stability", "Holds every tier against the exact answer where collision queries are known to fail");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  StabilitySettings& settings = options->settings;
  command->add_option("--cases", settings.cases, "In all, over the families alike")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1'000'000'000}))
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "Another seed, other cases")->capture_default_str();
  command->add_option("--resolution", settings.resolutions, "Pixels of the scopes' longer side, with commas between")
      ->delimiter(',')
      ->check(CLI::Range(1u, kMaxResolution))
      ->type_name("N,...")
      ->capture_default_str();
  command->add_option("--out", options->out, "Folder for a page and tables of every family")->type_name("DIR");
  command->add_option("--family", settings.families, "Only these")->check(CLI::IsMember(hardFamilyNames()));
  command->add_option("--first", settings.first, "Number of each family's first case");
  command->add_option("--device", options->device, "Number of the device, as cyber-radar devices lists them")
      ->type_name("I");
  command->callback([options, &status] { status = stability(*options); });
}

}  // namespace radar::tools
