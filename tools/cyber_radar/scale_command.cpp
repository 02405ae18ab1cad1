#include <algorithm>
#include <filesystem>
#include <iostream>

#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/query_run.h"
#include "measure/plot.h"
#include "measure/scale.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar scale --quick --out scaling           about a minute
  cyber-radar scale --mode naive --device 0,1 --out scaling
  cyber-radar scale batch.json --mode contact --sensors 64,256,1024

Without a query file, the paper's Figure 7: teapots, all of them sensors, fly among boxes; each step is a batch. With
one, its batches; --sensors N,... then takes the first N queries of each. DIR receives index.html, a page with the chart
and the tables; these as .csv, the chart as scale.svg; report.json; and trace.json, a timeline for ui.perfetto.dev.)";

constexpr const char* kLegend = R"(
The devices' time adds up to 100%: useful (each device as fast as alone), slower (because of the others), and idle: start (a
batch's first chunk is encoded), gap (the next chunk is not encoded yet), tail (another device's last chunk), scene (it is
edited). encode: time encoding over time with the device. cores: processor cores in use by this process.

Stages of the most sensors, milliseconds of a pass with timestamps, summed over devices:
)";

struct Options {
  std::string file, device = "all", mode = "sampled", out;
  EngineOptions engine;
  std::vector<uint32_t> sensors;
  uint32_t boxes = 2'000, steps = 20, repeats = 5;
  bool quick = false;
};

std::vector<ScalePoint> figure7Points(const Options& options) {
  std::vector<ScalePoint> points;
  for (const uint32_t sensors : options.sensors) {
    Figure7 settings;
    settings.teapots = sensors;
    settings.boxes = options.boxes;
    settings.steps = options.steps;
    points.push_back({static_cast<double>(sensors), makeWorkload(settings)});
  }
  return points;
}

// The first `most` queries of each batch; all for 0.
ScalePoint firstOf(const Workload& whole, uint32_t most) {
  ScalePoint point;
  point.workload = whole;
  point.workload.queries.clear();
  const std::vector<Batch> batches = batchesOf(whole.queries);
  for (const Batch& batch : batches) {
    const size_t count = most == 0 ? batch.queries.size() : std::min<size_t>(most, batch.queries.size());
    for (size_t i = 0; i < count; ++i) point.workload.queries.push_back(whole.queries[batch.numbers[i]]);
  }
  point.sensors = static_cast<double>(point.workload.queries.size()) / static_cast<double>(batches.size());
  return point;
}

std::vector<ScalePoint> filePoints(const Options& options) {
  std::vector<std::string> warnings;
  Outputs outputs;
  if (!options.out.empty()) outputs.addIn("--out", options.out, {"report.json", "trace.json"});
  const Workload whole = queriesToMeasure(options.file, warnings, outputs);
  printWarnings(warnings);
  std::vector<ScalePoint> points;
  if (options.sensors.empty()) points.push_back(firstOf(whole, 0));
  for (const uint32_t most : options.sensors) points.push_back(firstOf(whole, most));
  return points;
}

std::vector<uint32_t> numbersOf(std::vector<uint32_t> asked) {
  if (!asked.empty()) return asked;
  const std::vector<DeviceReport> reports = listDevices();
  for (uint32_t i = 0; i < reports.size(); ++i) {
    if (reports[i].usable()) asked.push_back(i);
  }
  return asked;
}

int scale(Options options) {
  if (options.quick) {
    options.steps = std::min(options.steps, 4u);
    options.repeats = std::min(options.repeats, 3u);
  }
  if (options.sensors.empty() && options.file.empty()) {
    options.sensors = options.quick ? std::vector<uint32_t>{5, 15, 30} : std::vector<uint32_t>{5, 10, 15, 20, 25, 30};
  }
  std::sort(options.sensors.begin(), options.sensors.end());
  ScaleSettings settings;
  settings.mode = options.mode == "contact" ? Mode::contact : Mode::sampled;
  settings.select = options.mode != "naive";
  settings.repeats = options.repeats;
  settings.resolution = options.engine.checked().resolution;
  const std::vector<uint32_t> asked = devicesFrom(options.device);
  if (!options.out.empty()) requireGnuplot();
  const std::vector<ScalePoint> points = options.file.empty() ? figure7Points(options) : filePoints(options);
  const std::vector<Device> devices = openDevices(asked);
  if (!options.out.empty()) makeFolder("--out", options.out);
  if (devices.size() == 1) {
    printWarnings({"there is one device, so nothing is compared; the tables say what limits it alone"});
  }
  ScaleReport measured;
  {
    Progress progress("measuring", scaleSteps(devices.size(), points.size(), settings));
    measured = measureScale(devices, numbersOf(asked), points, settings, [&] { progress.add(1); });
  }
  const std::string title =
      (options.file.empty() ? print("Teapots among %u boxes, %u steps, resolution ", options.boxes, options.steps) +
                                  options.engine.resolution
                            : options.file) +
      "; mode " + options.mode;
  std::vector<std::string> names;
  for (size_t i = 0; i < devices.size(); ++i) {
    names.push_back("device " + std::to_string(measured.numbers[i]) + ": " + devices[i].name() + ", " +
                    devices[i].driver());
  }
  Json report = newReport(title, {{"devices", names}});
  addTables(measured, report);
  Json& runs = partOf(report, "runs");
  const std::string commit = report["commit"];
  std::cout << title << "; commit " << commit << ", " << report["date"].get<std::string>() << "\n";
  for (const std::string& name : names) std::cout << name << "\n";
  std::cout << "\n" << textOf(runs["rows"]) << kLegend << textOf(partOf(report, "stages")["rows"]);
  if (!measured.sameBits) std::cout << "\nThe answers differ between sets of devices: the drivers are not alike.\n";
  if (!options.out.empty()) {
    const std::filesystem::path folder = options.out;
    writeAtomically(folder / "trace.json", traceOf(measured));
    writeReport(folder, report);
    const std::string origin = namesOf(devices) + "; " + report["processor"].get<std::string>() + "; commit " + commit;
    drawFor(runs, folder, "scale",
            plot(kLinesScript, scaleLines(runs["rows"]),
                 {title, origin, "sensors in a batch", "devices", "milliseconds per batch",
                  "speed-up over the first device", "efficiency, %"}));
    writeReport(folder, report);
    std::cout << "\nIn " << std::filesystem::absolute(folder).string()
              << ": index.html, report.json, trace.json, tables as .csv, the chart as scale.svg\n";
  }
  return 0;
}

}  // namespace

void addScaleCommand(Program& program) {
  Command command = program.add(
      "scale", "Measures how the work scales over devices, and what limits it: a table, a chart, a timeline",
      kExamples);
  auto options = std::make_shared<Options>();
  command.option("FILE.json", &options->file, "Query file; else the paper's Figure 7");
  addDevicesTo(command, options->device);
  command
      .option("--mode", &options->mode,
              "sampled: the paper's method on the objects in reach; naive: on all objects, as the paper does; contact: "
              "exact")
      .oneOf({"sampled", "naive", "contact"});
  command.option("--sensors", &options->sensors, "Sensors of a batch, with commas between: the axis; else 5 to 30")
      .list()
      .within(1, 1'000'000)
      .value("N,...");
  command.option("--boxes", &options->boxes, "Boxes in the scene").value("N").within(1, 1'000'000);
  command.option("--steps", &options->steps, "Time steps, each a batch").value("N").within(1, 100'000);
  command.option("--repeat", &options->repeats, "Timed passes; the median counts").value("N").within(1, 10'000);
  command.option("--resolution", &options->engine.resolution, "Pixels of a window's longer side").value("N|auto");
  command.option("--out", &options->out, "Folder for a table, a chart and a timeline").value("DIR");
  command.option("--quick", &options->quick, "At most 4 steps and 3 passes; 5, 15 and 30 sensors: about a minute");
  command.run([options] { return scale(*options); });
}

}  // namespace radar::tools
