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

void addSelftestCommand(Program& program) {
  Command command = program.add(
      "selftest", "Tries every device: its arithmetic, its answers, its speed; leaves a report to read and to send",
      kExamples);
  auto options = std::make_shared<Options>();
  command.option("--minutes", &options->minutes, "Time limit, over all devices").value("N").within(0.1, 10'000);
  addDevicesTo(command, options->device);
  command.option("--out", &options->out, "Folder for the report").value("DIR").required();
  command.run([options] { return selftest(*options); });
}

}  // namespace radar::tools
