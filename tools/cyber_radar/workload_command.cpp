#include <functional>
#include <iostream>

#include "batch/query_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "import/mesh_import.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"
#include "workloads/interlocking.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar workload table1 --boxes 30000 --shape box --out table1
  cyber-radar workload figure7 --teapots 30 --steps 100 --out figure7
  cyber-radar workload meshes --mesh bunny.ply dragon.obj --out meshes
  cyber-radar query meshes/queries.json

Equal options give equal files on every machine.)";

struct MeshFiles : RandomPoses {
  std::vector<std::string> files;
};

struct HardCases {
  std::string family;
  uint64_t seed = 1, first = 0;
  uint32_t cases = 1;
};

Workload makeWorkload(const HardCases& options) {
  return hardScene(hardFamily(options.family), options.seed, options.first, options.cases, Company::mixed);
}

// What writeQueryFile() would write over.
void requireUntouched(const MeshFiles& settings, const std::string& folder) {
  Outputs outputs;
  for (size_t i = 0; i < settings.files.size(); ++i) {
    outputs.addIn("--out", folder, {"mesh-" + std::to_string(i) + ".ply"});
  }
  for (const std::string& file : settings.files) outputs.requireNone(splitMeshName(file).file);
}
template <class Other>
void requireUntouched(const Other&, const std::string&) {}

Workload makeWorkload(const MeshFiles& options) {
  RandomPoses settings = options;
  std::vector<std::string> warnings;
  for (const std::string& file : options.files) settings.meshes.push_back(readMesh(file, warnings));
  printWarnings(warnings);
  return makeWorkload(settings);
}

void addCount(CLI::App& command, const char* name, uint32_t& count, const char* about) {
  command.add_option(name, count, about)->check(CLI::Range(1u, 100'000'000u))->type_name("N")->capture_default_str();
}

/// The subcommand of one workload, with the options that all have and those that `addOptions` adds.
template <class Settings>
void addWorkload(CLI::App& parent, const char* name, const char* about,
                 const std::function<void(CLI::App&, Settings&)>& addOptions) {
  CLI::App* command = parent.add_subcommand(name, about);
  auto settings = std::make_shared<Settings>();
  auto out = std::make_shared<std::string>();
  command->add_option("--out", *out, "Folder for queries.json, its meshes and instance files")
      ->required()
      ->type_name("DIR");
  command->add_option("--seed", settings->seed, "Equal seeds give equal workloads")
      ->type_name("N")
      ->capture_default_str();
  auto binary = std::make_shared<bool>(false);
  command->add_flag("--binary", *binary, "Writes the queries as an array, in queries.npy, without their ids");
  addOptions(*command, *settings);
  command->callback([settings, out, binary] {
    requireUntouched(*settings, *out);
    const Workload workload = makeWorkload(*settings);
    const auto file = writeQueryFile(workload, *out, *binary);
    std::cout << file.string() << ": " << counted(workload.queries.size(), "query", "queries") << ", "
              << counted(workload.scenes.size(), "scene") << ", " << counted(workload.meshes.size(), "mesh", "meshes")
              << "\n";
  });
}

template <class Settings>
void addBoxOptions(CLI::App& command, Settings& settings) {
  addCount(command, "--boxes", settings.boxes, "Boxes in the scene");
  addCount(command, "--sensors", settings.sensors, "Sensors in the batch");
  command
      .add_option_function<std::string>(
          "--shape",
          [&settings](const std::string& shape) {
            settings.shape = shape == "box" ? SensorShape::box : SensorShape::teapot;
          },
          "Of the sensors")
      ->check(CLI::IsMember({"box", "teapot"}))
      ->default_str("teapot");
}

template <class Settings>
void addObjectOptions(CLI::App& command, Settings& settings) {
  addCount(command, "--objects", settings.objects, "Objects in the scene");
  addCount(command, "--sensors", settings.sensors, "Sensors in the batch");
}

}  // namespace

void addWorkloadCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("workload", "Writes the query files of the benchmarks and tests");
  command->footer(kExamples);
  command->require_subcommand(1);
  addWorkload<Table1>(*command, "table1", "The paper's Table 1: random boxes in one cube, one batch",
                      addBoxOptions<Table1>);
  addWorkload<Scale>(*command, "scale", "Boxes at one density in a cube that grows, one batch", addBoxOptions<Scale>);
  addWorkload<Figure7>(*command, "figure7", "The paper's Figure 7: teapots, all of them sensors, fly on",
                       [](CLI::App& figure7, Figure7& settings) {
                         addCount(figure7, "--teapots", settings.teapots, "Teapots that fly");
                         addCount(figure7, "--boxes", settings.boxes, "Boxes in the scene");
                         addCount(figure7, "--steps", settings.steps, "Time steps, each a scene and a batch");
                       });
  addWorkload<Soups>(*command, "soup", "Random triangles of every kind, degenerate ones too",
                     [](CLI::App& soup, Soups& settings) {
                       addObjectOptions(soup, settings);
                       addCount(soup, "--triangles", settings.triangles, "Triangles of each mesh");
                     });
  addWorkload<InterlockingPairs>(*command, "interlocking",
                                 "Pairs of shapes inside each other, far from other pairs: costly queries, one batch",
                                 [](CLI::App& interlocking, InterlockingPairs& settings) {
                                   addCount(interlocking, "--sensors", settings.sensors, "Pairs, each with a sensor");
                                   interlocking
                                       .add_option_function<std::string>(
                                           "--shape",
                                           [&settings](const std::string& shape) {
                                             for (const Interlocking kind : kInterlocking) {
                                               if (shape == nameOf(kind)) settings.kind = kind;
                                             }
                                           },
                                           "Of the pairs")
                                       ->check(CLI::IsMember({"ring on peg", "comb in comb", "crossing"}))
                                       ->default_str(nameOf(Interlocking::ringOnPeg));
                                 });
  addWorkload<HardCases>(
      *command, "hard", "Cases of a family in which queries are known to fail, in one scene",
      [](CLI::App& hard, HardCases& settings) {
        hard.add_option("--family", settings.family, "Which")->required()->check(CLI::IsMember(hardFamilyNames()));
        hard.add_option("--first", settings.first, "Number of the first case")->capture_default_str();
        addCount(hard, "--cases", settings.cases, "How many");
      });
  addWorkload<MeshFiles>(*command, "meshes", "Given meshes in random poses", [](CLI::App& meshes, MeshFiles& settings) {
    addObjectOptions(meshes, settings);
    meshes.add_option("--mesh", settings.files, "Mesh files")->required()->type_name("FILE...");
  });
}

}  // namespace radar::tools
