#include <iostream>

#include "batch/answer_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar sweep hall.glb robot.ply --direction 1 0 0 --distance 5
  cyber-radar sweep ring.obj peg.stl --at 0 0 -3 --rotate 0 1 0 15 --direction 0 0 1 --distance 8 --speed 0.5
  cyber-radar sweep ring.obj peg.stl --direction 0 0 1 --distance 8 --json | python3 -m json.tool

SCENE and SENSOR are any files assimp reads (OBJ, PLY, STL, glTF, ...), in one common unit. The scene stands as it is;
the sensor is turned (--rotate), put in its place (--at) and moved along --direction for --distance.)";

struct Options {
  EngineOptions engine;
  SweepOptions sweep;
  bool json = false;
};

std::string introduction(const Workload& workload) {
  const QuerySpec& query = workload.queries.front();
  std::string text;
  const auto addMesh = [&](const char* role, const MeshData& mesh) {
    text += role + mesh.name + ", " + std::to_string(mesh.triangleCount()) + " triangles\n";
  };
  addMesh("scene:  ", workload.meshes[0]);
  addMesh("sensor: ", workload.meshes[1]);
  return text + "moves " + inDigits(query.distance) + " along " + inDigits(query.direction) + "\n";
}

int sweep(const Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  const Workload workload = options.sweep.load();
  const QuerySpec& query = workload.queries.front();
  Answering answering(workload, engine);
  answering.setUp();
  const Answer answer = answering.run("sweeping").answers.front();
  if (options.json) {
    std::cout << answerLine(query, answer.result, answer.mode, answer.reason) << "\n";
  } else {
    std::cout << introduction(workload) << "\n" << inWords(workload, query, answer);
    const std::string resolution = resolutionsInWords({answer});
    if (!resolution.empty()) {
      std::cout << "  " << resolution << (engine.resolution == 0 ? " (chosen)" : "") << " on "
                << answering.devices()[0].name() << "\n";
    }
  }
  return answer.result.status == Status::invalid ? kStatusSomeInvalid : 0;
}

}  // namespace

void addSweepCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("sweep", "Moves one mesh through another and says what it hits, and where");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->sweep.scene, "Mesh file of what stands still")->required();
  command->add_option("SENSOR", options->sweep.sensor, "Mesh file of what moves")->required();
  options->sweep.addMotionTo(*command);
  command->add_option("--speed", options->sweep.speed, "Units per second; the answer then says when")->type_name("S");
  options->engine.addTo(*command);
  command->add_flag("--json", options->json, "Prints the answer as one line of an answer file");
  command->callback([options, &status] { status = sweep(*options); });
}

}  // namespace radar::tools
