#include <cmath>
#include <filesystem>
#include <iostream>

#include "batch/atomic_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "import/input_error.h"
#include "measure/selftest.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar selftest --out report                  all devices, five minutes: open report/index.html
  cyber-radar selftest --minutes 1 --device 0 --out report

DIR receives index.html, a page with charts, report.txt and, for programs, report.json and tables as .csv. All are on
disk whenever a part ends, also if the run is interrupted. Exit status 1 if anything is wrong.)";

struct Options {
  std::string device = "all", out;
  double minutes = 5;
};

int selftest(const Options& options) {
  const std::vector<uint32_t> numbers = devicesFrom(options.device);
  // A range check of the parser lets through what is not a number.
  if (std::isnan(options.minutes)) throw InputError("--minutes", "nan", "expected a number of minutes");
  Json report = lookAtDevices(numbers);
  makeFolder("--out", options.out);
  const std::filesystem::path folder = options.out;
  runSelftest(report, options.minutes, [&] {
    for (const Json& part : report["parts"]) {
      if (part["state"] == "running") std::cerr << part["title"].get<std::string>() << "\n";
    }
    writeReport(folder, report);
    writeAtomically(folder / "report.txt", reportText(report));
  });
  std::cout << summaryOf(report) << "\nIn " << std::filesystem::absolute(folder).string()
            << ": index.html, report.txt, report.json, and tables as .csv\n";
  return report["right"] ? 0 : 1;
}

}  // namespace

void addSelftestCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "selftest", "Tries every device: its arithmetic, its answers, its speed; leaves a report to read and to send");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("--minutes", options->minutes, "Time limit, over all devices")
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
