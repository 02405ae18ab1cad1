#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <thread>

#include "baselines/baseline.h"
#include "batch/query_file.h"
#include "chart/charts.h"
#include "chart/run.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/origin.h"
#include "import/mesh_import.h"
#include "plot/plot.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar chart --quick --out chart             about a minute
  cyber-radar chart --out chart --mesh bunny.ply    all of it: a quarter of an hour
  cyber-radar chart --out chart batch.json          with queries of your own
  cyber-radar chart --out docs/chart --render       measures nothing: draws the charts again

DIR receives chart.csv with all measurements; methods.csv, workloads.csv and growth.csv, which sum them up; points.csv with
what the charts show; and the charts as SVG files. A program built with -DRADAR_BASELINES=ON (./tools/bootstrap chart) also
measures other libraries.)";

struct Options {
  std::vector<std::string> files, meshes;
  std::string out, device, extent = "full";
  bool quick = false, render = false;
};

// What a file and a link can be named after, and no case is yet.
std::string nameFor(const std::string& file, const std::vector<Case>& cases) {
  std::string stem = std::filesystem::path(file).stem().string();
  for (char& c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    c = plain ? static_cast<char>(std::tolower(c)) : '-';
  }
  std::string name = stem;
  const auto isTaken = [&](const Case& one) { return one.name == name; };
  for (int i = 2; std::any_of(cases.begin(), cases.end(), isTaken); ++i) name = stem + "-" + std::to_string(i);
  return name;
}

// For a shell.
std::string asArgument(const std::string& text) {
  const auto isPlain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/._-+,=:@%", c);
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), isPlain)) return text;
  std::string argument = "'";
  for (const char c : text) argument += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return argument + "'";
}

std::vector<Case> casesOf(const Options& options, Extent extent) {
  std::vector<Case> cases = frontCases(extent);
  std::vector<std::string> warnings;
  std::vector<MeshData> meshes;
  for (const std::string& file : options.meshes) meshes.push_back(readMesh(file, warnings));
  if (!meshes.empty()) cases.push_back(meshesCase(extent, std::move(meshes)));
  for (const std::string& file : options.files) {
    Workload workload = readQueryFile(file, warnings);
    if (workload.queries.empty()) throw InputError(file, "queries", "expected at least one query, got none");
    cases.push_back({"front", nameFor(file, cases), "Queries of " + file, 0, std::move(workload)});
  }
  printWarnings(warnings);
  for (auto* more : {table1Cases, growthCases}) {
    for (Case& which : more(extent)) cases.push_back(std::move(which));
  }
  return cases;
}

std::string commandOf(const Options& options) {
  std::string command = "cyber-radar chart --out " + asArgument(options.out);
  if (options.extent != "full") command += " --extent " + options.extent;
  if (!options.device.empty()) command += " --device " + options.device;
  for (const std::string& mesh : options.meshes) command += " --mesh " + asArgument(mesh);
  for (const std::string& file : options.files) command += " " + asArgument(file);
  return command;
}

Record measure(const Options& options) {
  EngineOptions engine;
  engine.device = options.device;
  const uint32_t number = engine.checked().device;
  RunSettings settings;
  settings.extent = options.extent == "full" ? Extent::full : options.extent == "quick" ? Extent::quick : Extent::least;
  settings.cases = casesOf(options, settings.extent);
  const Device device = Device::open({.index = number});
  settings.methods = [&, extent = settings.extent](const std::string& section) {
    const uint32_t threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<Method> methods = ours(device, section, extent, threads);
    for (Method& method : others(section, extent, threads)) methods.push_back(std::move(method));
    return methods;
  };
  Record record;
  record.add("command", commandOf(options));
  record.add("machine", processorInWords());
  record.add("device", device.name() + ", " + device.driver());
  record.add("commit", commit());
  for (const BaselineRow& row : peerRows()) {
    record.add("library", row.family + " (" + row.product + "): " + row.limits);
  }
  for (const Case& which : settings.cases) {
    if (which.section == "front") record.add("workload", which.name + ": " + which.about);
  }
  record.add("date", today());
  size_t cells = 0;
  for (const Case& which : settings.cases) cells += settings.methods(which.section).size();
  Progress progress("measuring", cells);
  return measureAll(settings, record, options.out, [&] { progress.add(1); });
}

void chart(Options options) {
  requireGnuplot();
  if (options.quick) options.extent = "quick";
  makeFolder("--out", options.out);
  std::optional<Record> record;
  if (options.render) {
    record = readRecord(options.out);
    if (!record) throw InputError("--out", options.out, "expected a folder with the chart.csv of an earlier run");
  } else {
    record = measure(options);
  }
  writeCharts(options.out, *record);
  std::cout << "Section front, by workload; microseconds per query:\n"
            << textOf(workloadTable(*record)) << "\nBy method; errors in sensor sizes:\n"
            << textOf(methodTable(*record)) << "\nAs the work grows; microseconds per query:\n"
            << textOf(growthTable(*record)) << "\nIn " << std::filesystem::absolute(options.out).string()
            << ": chart.csv, these tables as CSV, charts as SVG\n";
}

}  // namespace

void addChartCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "chart", "Measures every mode, and other libraries, on the same queries: accuracy against speed, in charts");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("FILE.json", options->files, "Query files: workloads of your own");
  command->add_option("--out", options->out, "Folder for what is measured and drawn")->required()->type_name("DIR");
  command->add_option("--mesh", options->meshes, "Mesh files: one more workload, of these in random poses")
      ->type_name("FILE...");
  command->add_option("--device", options->device, "Number of the device, as cyber-radar devices lists them")
      ->type_name("I");
  command->add_option("--extent", options->extent, "How much: full; quick, about a minute; least, to try it out")
      ->check(CLI::IsMember({"full", "quick", "least"}))
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "--extent quick");
  command->add_flag("--render", options->render, "Measure nothing: draw what --out holds");
  command->callback([options] { chart(*options); });
}

}  // namespace radar::tools
