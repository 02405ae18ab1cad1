#include <iostream>

#include "cyber_radar/progress.h"
#include "lab/commands.h"
#include "measure/tune.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  radar-lab tune --out tuned                 two minutes on a GPU
  radar-lab tune --share 0.02                on lavapipe

Each number that shapes the search (engine/contact/tuning.h) is tried with several values on five workloads; then those
that are more than 2% faster, together: the last row. Below 1 is faster than usual. Answers do not change, and are
compared.)";

struct Options {
  TuneSettings settings;
  std::string out;
  uint32_t device = kNone;
};

int tuneDevice(const Options& options) {
  const Device device = Device::open({.index = options.device});
  if (!options.out.empty()) makeFolder("--out", options.out);
  Json report =
      newReport("Cyber Radar: what the search is fastest with", {{"device", device.name() + ", " + device.driver()}});
  {
    Progress progress("trying", tuneSteps(device));
    tune(device, options.settings, report, [&] { progress.add(1); });
  }
  std::cout << "device " << device.name() << ", driver " << device.driver() << ", commit "
            << report["commit"].get<std::string>() << "\n"
            << textOf(partOf(report, "tune")["rows"]);
  if (!options.out.empty()) writeReport(options.out, report);
  return 0;
}

}  // namespace

void addTuneCommand(Program& program) {
  Command command = program.add(
      "tune", "Tries on a device which numbers the search is fastest with; answers stay as they are", kExamples);
  auto options = std::make_shared<Options>();
  command.option("--share", &options->settings.share, "Of the usual numbers of queries and boxes, for slow devices")
      .within(1e-6, 100)
      .value("X");
  command.option("--repeat", &options->settings.repeats, "Searches that count, of each setting and workload")
      .within(1, 1'000)
      .value("N");
  command.option("--device", &options->device, "Number of the device, as cyber-radar devices lists them").value("I");
  command.option("--out", &options->out, "Folder for a page and the table").value("DIR");
  command.run([options] { return tuneDevice(*options); });
}

}  // namespace radar::tools
