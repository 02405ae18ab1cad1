#include <iostream>

#include "batch/answer_rows.h"
#include "cyber_radar/answer_page.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"
#include "import/mesh_import.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar sweep hall.glb robot.ply --direction 1 0 0 --distance 5
  cyber-radar sweep ring.obj peg.stl --at 0 0 -3 --rotate 0 1 0 15 --direction 0 0 1 --distance 8 --speed 0.5
  cyber-radar sweep frame.stl door.stl --turn 0 0 1 1.57 --centre 0.9 0 0
  cyber-radar sweep gearbox.glb gearbox.glb#shaft --exclude shaft --direction 0 0 1 --distance 90 --hits all
  cyber-radar sweep hall.glb part.stl --sensor-scale 0.001 --direction 0 0 1 --distance 2
  cyber-radar sweep floor.stl crate.stl --direction 0 0 1 --distance 8 --ignore-leaving
  cyber-radar sweep ring.obj peg.stl --direction 0 0 1 --distance 8 --json | python3 -m json.tool
  cyber-radar sweep ring.obj peg.stl --direction 0 0 1 --distance 8 --expect clear
  cyber-radar sweep ring.obj peg.stl --direction 0 0 1 --distance 8 --view sweep.html

SCENE and SENSOR are OBJ, STL, PLY, OFF, 3MF or glTF 2 files, or what assimp reads besides, in one common unit after
--scale and --sensor-scale; FILE#3 or FILE#NAME is one node of a file, in its own frame. As SENSOR, ball:2 is a ball of
radius 2; a mesh is rounded by --clearance. The scene stands as it is, each of
its nodes an object (cyber-radar info lists them); the sensor, one mesh, is turned (--rotate), put in its place (--at) and
moved along --direction for --distance. With --turn it turns meanwhile, or on the spot.)";

struct Options {
  EngineOptions engine;
  SweepOptions sweep;
  std::string view, expect;
  bool json = false;
};

std::string introduction(const Workload& workload, const std::filesystem::path& scene) {
  const QuerySpec& query = workload.queries.front();
  const std::vector<Instance>& objects = workload.scenes.front().instances;
  const MeshData& sensor = workload.meshes[query.mesh];
  uint64_t triangles = 0;
  for (const Instance& object : objects) triangles += workload.meshes[object.mesh].triangleCount();
  return "scene:  " + scene.filename().string() + (objects.size() > 1 ? ", " + counted(objects.size(), "object") : "") +
         ", " + counted(triangles, "triangle") + "\nsensor: " + sensor.name + ", " +
         counted(sensor.triangleCount(), "triangle") + "\n" + courseInWords(query);
}

// The exit status; says on standard error what it is for.
int judge(Status status, const std::string& expect) {
  if (status == Status::invalid) return kStatusSomeInvalid;
  const bool isHit = status == Status::hit || status == Status::overlap;
  if (expect.empty() || (expect == "hit" ? isHit : status == Status::clear)) return 0;
  std::cerr << "cyber-radar: --expect: expected " << expect << ", got " << nameOf(status) << "\n";
  return kStatusNotAsWanted;
}

int sweep(const Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  Outputs outputs;
  if (!options.view.empty()) {
    outputs.add("--view", options.view);
    for (const std::string& mesh : {options.sweep.scene, options.sweep.sensor}) {
      outputs.requireNone(splitMeshName(mesh).file);
    }
  }
  const Workload workload = options.sweep.load();
  Answering answering(workload, modesOf(workload), engine);
  const Answer answer = answersTo(workload, answering, "sweeping").front();
  if (options.json) {
    std::cout << AnswerRows(workload, AnswerFormat::lines).text(0, workload.queries, {&answer, 1});
  } else {
    std::cout << introduction(workload, options.sweep.scene) << "\n"
              << inWords(workload, workload.queries.front(), answer);
    const std::string resolution = resolutionsInWords(answering.stats());
    if (!resolution.empty()) {
      std::cout << "  " << resolution << (engine.resolution == 0 ? " (chosen)" : "") << " on "
                << answering.answerer().devices()[0].name() << "\n";
    }
  }
  if (!options.view.empty()) {
    const std::span<const Device> devices = answering.answerer().devices();
    writePage(options.view, options.sweep.sensor + " in " + options.sweep.scene, workload, {&answer, 1},
              {.device = devices.empty() ? nullptr : &devices[0]});
    (options.json ? std::cerr : std::cout) << "page: " << options.view << "\n";
  }
  return judge(answer.result.status, options.expect);
}

}  // namespace

void addSweepCommand(Program& program) {
  Command command = program.add("sweep", "Moves one mesh through another and says what it hits, and where", kExamples);
  auto options = std::make_shared<Options>();
  command.option("SCENE", &options->sweep.scene, "Mesh file of what stands still").required();
  command.option("SENSOR", &options->sweep.sensor, "Mesh file of what moves, or ball:RADIUS").required();
  options->sweep.addMotionTo(command);
  options->sweep.addTurnTo(command);
  options->sweep.addFieldsTo(command);
  options->engine.addTo(command);
  command.option("--view", &options->view, "Writes a page here that shows the answer in any browser")
      .value("FILE.html");
  command.option("--json", &options->json, "Prints the answer as one line of an answer file");
  command
      .option("--expect", &options->expect,
              "Ends with exit status 1 if the answer is another one; an overlap is a hit, too")
      .oneOf({"clear", "hit"});
  command.run([options] { return sweep(*options); });
}

}  // namespace radar::tools
