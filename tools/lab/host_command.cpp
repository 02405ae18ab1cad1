#include <algorithm>
#include <iostream>

#include "cyber_radar/progress.h"
#include "import/input_error.h"
#include "lab/commands.h"
#include "measure/host.h"
#include "measure/host_model.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  radar-lab host --queries 65536,1048576 --threads 1,0
  radar-lab host --queries 1,1024,16384,65536 --model

Microseconds a query, medians. host: what the calling thread computes in a call of Sweeper::run(); plan: it lists what to
search; submit: all threads state the searches in mapped memory, and commands are recorded; decode: all threads make
answers of results, while the device works on the next submission. device: its stages. cpu_search: the search of the same
batch by one thread; host_share: host over that.)";

struct Options {
  HostSettings settings;
  std::string out;
  uint32_t device = kNone;
  bool model = false;
};

int measureHost(const Options& options) {
  const auto has = [](const std::vector<uint32_t>& all, uint32_t one) { return std::ranges::count(all, one) > 0; };
  if (options.model && !(has(options.settings.queries, 1) && has(options.settings.threads, 1))) {
    throw InputError("--model", "", "expected 1 among --queries and among --threads, got others");
  }
  const Device device = Device::open({.index = options.device});
  if (!options.out.empty()) makeFolder("--out", options.out);
  Json report =
      newReport("Cyber Radar: what a call costs the host", {{"device", device.name() + ", " + device.driver()}});
  {
    Progress progress("measuring", hostRowCount(options.settings));
    setRows(report, "host", "Microseconds a query", hostRows(device, options.settings, [&] { progress.add(1); }));
  }
  std::cout << "device " << device.name() << ", driver " << device.driver() << ", commit "
            << report["commit"].get<std::string>() << "\n"
            << textOf(partOf(report, "host")["rows"]);
  if (options.model) {
    const std::string assumptions = modelAssumptions();
    setRows(report, "model", "What a GPU that was measured elsewhere would answer",
            modelRows(partOf(report, "host")["rows"]));
    partOf(report, "model")["note"] = assumptions;
    std::cout << "\n" << assumptions << textOf(partOf(report, "model")["rows"]);
  }
  if (!options.out.empty()) writeReport(options.out, report);
  return 0;
}

}  // namespace

void addHostCommand(Program& program) {
  Command command =
      program.add("host", "Measures what a call costs the host, beside what it costs the device", kExamples);
  auto options = std::make_shared<Options>();
  command.option("--queries", &options->settings.queries, "Sizes of batches, with commas between")
      .list()
      .within(1, 10'000'000)
      .value("N,...");
  command.option("--threads", &options->settings.threads, "Numbers of threads, 0 for one of each core")
      .list()
      .within(0, 4096)
      .value("N,...");
  command.option("--repeat", &options->settings.repeats, "Calls that count").within(1, 10'000).value("N");
  command.option(
      "--model", &options->model,
      "Prints, too, what a GPU that was measured elsewhere would answer with this host, with what is assumed");
  command.option("--device", &options->device, "Number of the device, as cyber-radar devices lists them").value("I");
  command.option("--out", &options->out, "Folder for a page and the table").value("DIR");
  command.run([options] { return measureHost(*options); });
}

}  // namespace radar::tools
