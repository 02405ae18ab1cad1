#include <iostream>

#include "batch/query_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "import/mesh_import.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar workload table1 --boxes 30000 --shape box --out table1
  cyber-radar workload figure7 --teapots 30 --steps 100 --out figure7
  cyber-radar workload meshes --mesh bunny.ply dragon.obj --out meshes
  cyber-radar query meshes/queries.json

Equal options give equal files on every machine.)";

struct Options {
  std::string out, shape = "teapot";
  std::optional<uint32_t> boxes, sensors, teapots, steps, objects, triangles;
  std::optional<uint64_t> seed;
  std::vector<std::string> meshes;
};

template <class Value>
void choose(Value& value, const std::optional<Value>& given) {
  if (given) value = *given;
}

template <class Settings>
Workload boxesOf(const Options& options) {
  Settings settings;
  choose(settings.boxes, options.boxes);
  choose(settings.sensors, options.sensors);
  choose(settings.seed, options.seed);
  settings.shape = options.shape == "box" ? SensorShape::box : SensorShape::teapot;
  return makeWorkload(settings);
}

Workload figure7Of(const Options& options) {
  Figure7 settings;
  choose(settings.teapots, options.teapots);
  choose(settings.boxes, options.boxes);
  choose(settings.steps, options.steps);
  choose(settings.seed, options.seed);
  return makeWorkload(settings);
}

Workload soupOf(const Options& options) {
  Soups settings;
  choose(settings.objects, options.objects);
  choose(settings.sensors, options.sensors);
  choose(settings.triangles, options.triangles);
  choose(settings.seed, options.seed);
  return makeWorkload(settings);
}

Workload meshesOf(const Options& options) {
  RandomPoses settings;
  std::vector<std::string> warnings;
  for (const std::string& file : options.meshes) settings.meshes.push_back(readMesh(file, warnings));
  printWarnings(warnings);
  choose(settings.objects, options.objects);
  choose(settings.sensors, options.sensors);
  choose(settings.seed, options.seed);
  return makeWorkload(settings);
}

/// The subcommand of one workload, with the options that all have.
CLI::App* addWorkload(CLI::App& parent, const std::string& name, const std::string& about,
                      const std::shared_ptr<Options>& options, Workload (*make)(const Options&)) {
  CLI::App* command = parent.add_subcommand(name, about);
  command->add_option("--out", options->out, "Folder for queries.json, its meshes and instance files")
      ->required()
      ->type_name("DIR");
  command->add_option("--seed", options->seed, "Equal seeds give equal workloads")->type_name("N");
  command->callback([options, make] {
    const Workload workload = make(*options);
    const auto file = writeQueryFile(workload, options->out);
    std::cout << file.string() << ": " << workload.queries.size() << " queries, " << workload.scenes.size()
              << " scenes, " << workload.meshes.size() << " meshes\n";
  });
  return command;
}

void addCount(CLI::App* command, const char* name, std::optional<uint32_t>& count, const char* about) {
  command->add_option(name, count, about)->check(CLI::Range(1u, 100'000'000u))->type_name("N");
}

void addShape(CLI::App* command, std::string& shape) {
  command->add_option("--shape", shape, "Of the sensors")
      ->check(CLI::IsMember({"box", "teapot"}))
      ->capture_default_str();
}

}  // namespace

void addWorkloadCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("workload", "Writes the query files of the benchmarks and tests");
  command->footer(kExamples);
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  CLI::App* table1 = addWorkload(*command, "table1", "The paper's Table 1: random boxes in one cube, one batch",
                                 options, boxesOf<Table1>);
  CLI::App* scale =
      addWorkload(*command, "scale", "Boxes at one density in a cube that grows, one batch", options, boxesOf<Scale>);
  for (CLI::App* boxes : {table1, scale}) {
    addCount(boxes, "--boxes", options->boxes, "Boxes in the scene");
    addCount(boxes, "--sensors", options->sensors, "Sensors in the batch");
    addShape(boxes, options->shape);
  }
  CLI::App* figure7 = addWorkload(*command, "figure7", "The paper's Figure 7: teapots, all of them sensors, fly on",
                                  options, figure7Of);
  addCount(figure7, "--teapots", options->teapots, "Teapots that fly");
  addCount(figure7, "--boxes", options->boxes, "Boxes in the scene");
  addCount(figure7, "--steps", options->steps, "Time steps, each a scene and a batch");
  CLI::App* soup =
      addWorkload(*command, "soup", "Random triangles of every kind, degenerate ones too", options, soupOf);
  CLI::App* meshes = addWorkload(*command, "meshes", "Given meshes in random poses", options, meshesOf);
  for (CLI::App* objects : {soup, meshes}) {
    addCount(objects, "--objects", options->objects, "Objects in the scene");
    addCount(objects, "--sensors", options->sensors, "Sensors in the batch");
  }
  addCount(soup, "--triangles", options->triangles, "Triangles of each mesh");
  meshes->add_option("--mesh", options->meshes, "Mesh files")->required()->type_name("FILE...");
}

}  // namespace radar::tools
