#include <algorithm>
#include <functional>

#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/workload_output.h"
#include "import/mesh_import.h"
#include "workloads/generate.h"
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

Option addCount(Command& command, const char* name, uint32_t& count, const char* about) {
  return command.option(name, &count, about).value("N").within(1, 100'000'000);
}

/// The subcommand of one workload, with the options that all have and those that `addOptions` adds.
template <class Settings>
void addWorkload(Command& parent, const char* name, const char* about,
                 const std::function<void(Command&, Settings&)>& addOptions) {
  Command command = parent.add(name, about);
  auto settings = std::make_shared<Settings>();
  auto output = std::make_shared<WorkloadOutput>();
  output->addTo(command);
  command.option("--seed", &settings->seed, "Equal seeds give equal workloads").value("N");
  addOptions(command, *settings);
  command.run([settings, output] {
    requireUntouched(*settings, output->folder);
    output->write(makeWorkload(*settings));
    return 0;
  });
}

template <class Settings>
void addBoxOptions(Command& command, Settings& settings) {
  addCount(command, "--boxes", settings.boxes, "Boxes in the scene");
  addCount(command, "--sensors", settings.sensors, "Sensors in the batch");
  const std::function<void(const std::string&)> set = [&settings](const std::string& shape) {
    settings.shape = shape == "box" ? SensorShape::box : SensorShape::teapot;
  };
  command.option("--shape", set, "Of the sensors; else teapots").oneOf({"box", "teapot"});
}

template <class Settings>
void addObjectOptions(Command& command, Settings& settings) {
  addCount(command, "--objects", settings.objects, "Objects in the scene");
  addCount(command, "--sensors", settings.sensors, "Sensors in the batch");
}

void addInterlockingOptions(Command& command, InterlockingPairs& settings) {
  addCount(command, "--sensors", settings.sensors, "Pairs, each with a sensor");
  std::vector<std::string> shapes;
  for (const Interlocking kind : kInterlocking) shapes.push_back(nameOf(kind));
  const std::function<void(const std::string&)> set = [&settings, shapes](const std::string& shape) {
    settings.kind = kInterlocking[std::ranges::find(shapes, shape) - shapes.begin()];
  };
  command.option("--shape", set, std::string("Of the pairs; else ") + nameOf(settings.kind)).oneOf(shapes);
}

}  // namespace

void addWorkloadCommand(Program& program) {
  Command command = program.add("workload", "Writes query files to try, of any size", kExamples);
  addWorkload<Table1>(command, "table1", "The paper's Table 1: random boxes in one cube, one batch",
                      addBoxOptions<Table1>);
  addWorkload<Scale>(command, "scale", "Boxes at one density in a cube that grows, one batch", addBoxOptions<Scale>);
  addWorkload<Figure7>(command, "figure7", "The paper's Figure 7: teapots, all of them sensors, fly on",
                       [](Command& figure7, Figure7& settings) {
                         addCount(figure7, "--teapots", settings.teapots, "Teapots that fly");
                         addCount(figure7, "--boxes", settings.boxes, "Boxes in the scene");
                         addCount(figure7, "--steps", settings.steps, "Time steps, each a scene and a batch");
                       });
  addWorkload<Soups>(command, "soup", "Random triangles of every kind, degenerate ones too",
                     [](Command& soup, Soups& settings) {
                       addObjectOptions(soup, settings);
                       addCount(soup, "--triangles", settings.triangles, "Triangles of each mesh");
                     });
  addWorkload<InterlockingPairs>(command, "interlocking",
                                 "Pairs of shapes inside each other, far from other pairs: costly queries, one batch",
                                 addInterlockingOptions);
  addWorkload<MeshFiles>(command, "meshes", "Given meshes in random poses", [](Command& meshes, MeshFiles& settings) {
    addObjectOptions(meshes, settings);
    meshes.option("--mesh", &settings.files, "Mesh files").required().value("FILE...");
  });
}

}  // namespace radar::tools
