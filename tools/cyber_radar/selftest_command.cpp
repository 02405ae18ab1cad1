#include <cmath>
#include <filesystem>
#include <iostream>

#include "batch/atomic_file.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/origin.h"
#include "import/input_error.h"
#include "report/print.h"
#include "selftest/selftest.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar selftest --out report                  all devices, five minutes: open report/index.html
  cyber-radar selftest --minutes 1 --device 0 --out report

The report is on disk whenever a part ends, also if the run is interrupted. Exit status 1 if anything is wrong.)";

struct Options {
  SelftestSettings settings;
  std::string device = "all", out;
};

void write(const SelftestReport& report, const std::filesystem::path& folder) {
  writeAtomically(folder / "report.txt", textOf(report));
  writeAtomically(folder / "report.json", jsonOf(report));
  writeAtomically(folder / "arithmetic.csv", arithmeticCsv(report));
  writeAtomically(folder / "exactness.csv", exactnessCsv(report));
  writeAtomically(folder / "throughput.csv", throughputCsv(report));
  writeAtomically(folder / "stages.csv", stagesCsv(report));
  writeAtomically(folder / "index.html", htmlOf(report));
}

// The part that is under way, on standard error.
void tellProgress(const SelftestReport& report) {
  for (const DeviceTest& device : report.devices) {
    for (const Part part : kParts) {
      if (device[part].state != PartState::running) continue;
      std::cerr << "device " << device.number << ", " << device.facts.name << ": " << nameOf(part) << "\n";
    }
  }
}

int selftest(Options options) {
  options.settings.devices = devicesFrom(options.device);
  // A range check of the parser lets through what is not a number.
  if (std::isnan(options.settings.minutes)) throw InputError("--minutes", "nan", "expected a number of minutes");
  const std::filesystem::path folder = options.out;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InputError("--out", options.out, "expected a folder, or a place for one");
  }
  SelftestReport report;
  report.command =
      print("cyber-radar selftest --minutes %g --device %s", options.settings.minutes, options.device.c_str());
  report.commit = commit();
  report.date = today();
  report.processor = processorInWords();
  lookAtDevices(options.settings, report);
  runSelftest(report, [&] {
    tellProgress(report);
    write(report, folder);
  });
  std::cout << textOf(report) << "\nIn " << std::filesystem::absolute(folder).string()
            << ": index.html, report.txt, report.json, and tables as .csv\n";
  return report.right() ? 0 : 1;
}

}  // namespace

void addSelftestCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "selftest", "Tries every device: its arithmetic, its answers, its speed; leaves a report to read and to send");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("--minutes", options->settings.minutes, "Time limit, over all devices")
      ->check(CLI::Range(0.1, 10'000.0))
      ->capture_default_str();
  command
      ->add_option("--device", options->device,
                   "Numbers of the devices, as cyber-radar devices lists them: 0,1, or all")
      ->type_name("I,...|all")
      ->capture_default_str();
  command->add_option("--out", options->out, "Folder for the report")->type_name("DIR")->required();
  command->callback([options, &status] { status = selftest(*options); });
}

}  // namespace radar::tools
