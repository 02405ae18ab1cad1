#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "baselines/baseline.h"
#include "batch/query_file.h"
#include "cyber_radar/options.h"
#include "import/mesh_import.h"
#include "lab/commands.h"
#include "measure/chart.h"
#include "measure/clearances.h"
#include "measure/developer.h"
#include "measure/plot.h"
#include "measure/single.h"
#include "measure/trees.h"
#include "measure/turning.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  radar-lab chart --extent quick --out chart             about a minute
  radar-lab chart --out chart --mesh bunny.ply    all of it: a quarter of an hour
  radar-lab chart --out chart batch.json          with queries of your own
  radar-lab chart --out chart --render            measures nothing: draws the charts again

DIR receives index.html, a page with charts and tables; the charts as SVG files and the tables as .csv; and report.json, which
has all measurements. Tables are on disk as soon as a workload is measured. gnuplot draws the charts: without it, all but they
are there, and --render draws them later, or elsewhere. A program built with -DRADAR_BASELINES=ON
(./tools/bootstrap chart) also measures other libraries.)";

struct Options {
  std::vector<std::string> files, meshes, sections{"front", "table1"};
  std::optional<std::string> device;
  std::string out, extent = "full";
  bool render = false;

  bool has(const char* section) const { return std::find(sections.begin(), sections.end(), section) != sections.end(); }
};

// What a file and a link can be named after, and no case is yet.
std::string nameFor(const std::string& file, const std::vector<Case>& cases) {
  std::string stem = std::filesystem::path(file).stem().string();
  for (char& c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    c = plain ? static_cast<char>(std::tolower(c)) : '-';
  }
  std::string name = stem;
  const auto isTaken = [&](const Case& one) { return one.workload == name; };
  for (int i = 2; std::any_of(cases.begin(), cases.end(), isTaken); ++i) name = stem + "-" + std::to_string(i);
  return name;
}

// Reads all files, so that none is refused after others were measured.
std::vector<Case> casesOf(const Options& options, Extent extent) {
  std::vector<Case> cases = frontCases(extent);
  std::vector<std::string> warnings;
  std::vector<MeshData> meshes;
  for (const std::string& file : options.meshes) meshes.push_back(readMesh(file, warnings));
  if (!meshes.empty()) cases.push_back(meshesCase(extent, std::move(meshes)));
  Outputs outputs;
  outputs.addIn("--out", options.out, {"report.json"});
  for (const std::string& file : options.files) {
    const Workload workload = queriesToMeasure(file, warnings, outputs);
    cases.push_back({.section = "front", .workload = nameFor(file, cases), .about = "Queries of " + file, .make = [=] {
                       return workload;
                     }});
  }
  printWarnings(warnings);
  for (auto* more : {table1Cases, growthCases, searchCases, contactCases}) {
    for (Case& which : more(extent)) cases.push_back(std::move(which));
  }
  std::erase_if(cases, [&](const Case& one) { return !options.has(one.section.c_str()); });
  return cases;
}

Json measure(const Options& options) {
  EngineOptions engine;
  engine.device = options.device;
  const uint32_t number = engine.checked().device;
  const Extent extent = options.extent == "full"    ? Extent::full
                        : options.extent == "quick" ? Extent::quick
                                                    : Extent::least;
  const std::vector<Case> cases = casesOf(options, extent);
  const Device device = Device::open({.index = number});
  makeFolder("--out", options.out);
  const std::vector<BaselineRow> libraries = peerRows();
  const auto methods = [&](const std::string& section) {
    const uint32_t threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<Method> all = ours(device, section, extent, threads);
    for (Method& method : others(libraries, section, extent, threads)) all.push_back(std::move(method));
    return all;
  };
  Json report = newReport("Cyber Radar: accuracy against speed", {{"device", device.name() + ", " + device.driver()}});
  Json rows = Json::array();
  for (const BaselineRow& row : libraries) {
    rows.push_back({{"library", row.family}, {"product", row.product}, {"limits", row.limits}});
  }
  if (!rows.empty()) setRows(report, "libraries", "Other libraries, and what they cannot do", rows);
  size_t cells = 0;
  for (const Case& one : cases) cells += methods(one.section).size();
  Progress progress("measuring", cells);
  measureCases({extent, cases, methods}, report, options.out, [&] { progress.add(1); });
  if (options.has("edits")) measureEdits(device, extent, report);
  if (options.has("trees")) measureTrees(extent, embreeTree, report);
  if (options.has("recorded")) measureRecorded(device, extent, report);
  if (options.has("clearances")) measureClearances(extent, report);
  if (options.has("turns")) measureTurns(extent, makeRigidBodies, report);
  if (options.has("single")) measureSingle(extent, libraries, report);
  return report;
}

Json readReport(const std::string& folder) {
  std::ifstream file(std::filesystem::path(folder) / "report.json");
  Json report = Json::parse(file, nullptr, false);
  if (report.is_discarded())
    throw InputError("--out", folder, "expected a folder with the report.json of an earlier run");
  return report;
}

void chart(Options options) {
  if (options.render) requireGnuplot();
  Json report = options.render ? readReport(options.out) : measure(options);
  const std::string whyUndrawn = tools::whyUndrawn();
  sumUp(report, options.out, whyUndrawn.empty());
  for (const char* name :
       {"workloads", "methods", "growth", "edits", "trees", "recorded", "clearances", "turns", "single", "threads"}) {
    Json& part = partOf(report, name);
    if (!part["rows"].empty()) std::cout << part["title"].get<std::string>() << ":\n" << textOf(part["rows"]) << "\n";
  }
  const std::string folder = std::filesystem::absolute(options.out).string();
  std::cout << "In " << folder << ": index.html, report.json, tables as .csv"
            << (whyUndrawn.empty() ? ", charts as .svg\n" : "\n");
  if (whyUndrawn.empty()) return;
  printWarnings({"the charts are not drawn: " + whyUndrawn +
                 "; then, here or where gnuplot is: radar-lab chart --render --out " + folder});
}

}  // namespace

void addChartCommand(Program& program) {
  Command command = program.add(
      "chart", "Measures every mode, and other libraries, on the same queries: accuracy against speed, in charts",
      kExamples);
  auto options = std::make_shared<Options>();
  command.option("FILE.json", &options->files, "Query files: workloads of your own");
  command.option("--out", &options->out, "Folder for what is measured and drawn").required().value("DIR");
  command.option("--mesh", &options->meshes, "Mesh files: one more workload, of these in random poses")
      .value("FILE...");
  command.option("--device", &options->device, "Number of the device, as cyber-radar devices lists them").value("I");
  command.option("--extent", &options->extent, "How much: full; quick, about a minute; least, to try it out")
      .oneOf({"full", "quick", "least"});
  command
      .option("--section", &options->sections,
              "What: front, accuracy against speed; table1, the paper's; growth of the work; and of our own searches: "
              "search, by size of batch; contacts, by kind; edits of a scene; trees, built and refitted, beside "
              "Embree's; recorded in a host's command buffer; "
              "clearances; turns, motions that turn, and an arm's; single, one query at a time, and on more threads")
      .list()
      .oneOf({"front", "table1", "growth", "search", "contacts", "edits", "trees", "recorded", "clearances", "turns",
              "single"});
  command.option("--render", &options->render, "Measure nothing: draw what --out holds");
  command.run([options] {
    chart(*options);
    return 0;
  });
}

}  // namespace radar::tools
