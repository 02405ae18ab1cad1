#include <cmath>
#include <cstdio>
#include <iostream>

#include "batch/answer_file.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/scene_picture.h"
#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kTeapots = 12, kPictures = 3;

struct Row {
  const QuerySpec& query;
  const Answer& sampled;
  const Answer& exact;
};

std::string number(double value, const char* format) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string tableOf(const std::vector<Row>& rows) {
  std::string text =
      "                    the paper's method (sampled)   exact (reference)\n"
      "teapot              status            t  object    status            t  object    late by\n";
  const auto object = [](const Result& result) { return result.object == kNone ? "-" : std::to_string(result.object); };
  for (const auto& [query, sampled, exact] : rows) {
    const Result &a = sampled.result, &b = exact.result;
    char line[160];
    std::snprintf(line, sizeof line, "%-20s%-10s%9s%8s    %-10s%9s%8s%11s\n", query.id.c_str(), nameOf(a.status),
                  number(a.t, "%.4f").c_str(), object(a).c_str(), nameOf(b.status), number(b.t, "%.4f").c_str(),
                  object(b).c_str(), number(a.t - b.t, "%.1e").c_str());
    text += line;
  }
  return text;
}

std::vector<Answer> answersIn(const Workload& workload, AnswerMode mode, const AnsweringOptions& engine,
                              std::string& device) {
  AnsweringOptions options = engine;
  options.mode = mode;
  Answering answering(workload, options);
  answering.setUp();
  std::vector<Answer> answers = answering.run(nameOf(mode)).answers;
  for (const Device& opened : answering.devices()) device = opened.name() + " (" + opened.driver() + ")";
  return answers;
}

/// The scopes of the first few teapots that hit something.
std::vector<std::string> drawHits(const std::filesystem::path& folder, const std::vector<Row>& rows, Sweeper& sweeper) {
  std::vector<std::string> files;
  for (size_t i = 0; i < rows.size() && files.size() < kPictures; ++i) {
    if (rows[i].sampled.result.status != Status::hit) continue;
    const Scopes scopes = sweeper.scopes(toQuery(rows[i].query, radar::Mode::sampled));
    const std::string name = "teapot-" + std::to_string(i) + ".png";
    writeScopePicture(folder / name,
                      rows[i].query.id + ":  d = " + inDigits(scopes.d) + ",  t = " + inDigits(scopes.result.t) +
                          ",  min(L) = " + leastFreeDistance(scopes),
                      scopes);
    files.push_back(name);
  }
  return files;
}

int demonstrate(const std::string& out, const AnsweringOptions& engine) {
  Figure7 settings;
  settings.teapots = kTeapots;
  settings.steps = 1;
  const Workload workload = makeWorkload(settings);
  const std::filesystem::path folder = out;
  const std::filesystem::path file = writeQueryFile(workload, folder);
  std::cout << kTeapots << " teapots of " << workload.meshes[1].triangleCount() << " triangles fly among "
            << settings.boxes << " boxes.\nWhat does each hit within " << inDigits(workload.queries[0].distance)
            << " units, and after how far?\n\n";

  std::string deviceName;
  const std::vector<Answer> sampled = answersIn(workload, AnswerMode::sampled, engine, deviceName);
  const std::vector<Answer> exact = answersIn(workload, AnswerMode::reference, engine, deviceName);
  std::vector<Row> rows;
  for (size_t i = 0; i < sampled.size(); ++i) rows.push_back({workload.queries[i], sampled[i], exact[i]});
  const std::string table = tableOf(rows);
  std::cout << table << "\nobjects below " << settings.boxes << " are boxes, the others teapots; sampled on "
            << deviceName << "\n";
  writeAtomically(folder / "table.txt", table);
  writeAtomically(folder / "answers-sampled.jsonl", answerLines(workload, sampled));
  writeAtomically(folder / "answers-reference.jsonl", answerLines(workload, exact));

  const uint32_t scene = workload.queries.front().scene;
  const Device device = Device::open({.index = engine.device});
  ScenePlayer player(workload);
  player.show(scene);
  Sweeper sweeper(device, player.scene());
  std::string pictures = "scene.png";
  for (const std::string& name : drawHits(folder, rows, sweeper)) pictures += ", " + name;
  std::vector<Flight> flights;
  for (const Row& row : rows) {
    const Result& result = row.exact.result;
    const bool touches = result.status != Status::clear;
    flights.push_back({row.query, touches ? result.t : row.query.distance, touches});
  }
  writeScenePicture(folder / "scene.png", workload, scene, flights, device);

  std::cout << "\nIn " << std::filesystem::absolute(folder).string() << ":\n  pictures   " << pictures
            << "\n  answers    table.txt, answers-sampled.jsonl, answers-reference.jsonl\n  questions  "
            << file.filename().string() << "; try: cyber-radar query " << file.string() << "\n";
  return exitStatusOf(sampled);
}

}  // namespace

void addDemoCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "demo", "The paper's teapots among boxes: a table of answers, and pictures of the scene and of R, M and L");
  auto out = std::make_shared<std::string>("cyber-radar-demo");
  auto engine = std::make_shared<EngineOptions>();
  command->add_option("--out", *out, "Folder for everything")->type_name("DIR")->capture_default_str();
  engine->addResolutionTo(*command);
  command->callback([out, engine, &status] { status = demonstrate(*out, engine->checked()); });
}

}  // namespace radar::tools
