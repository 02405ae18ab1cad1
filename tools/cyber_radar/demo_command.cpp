#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "batch/answer_file.h"
#include "batch/query_file.h"
#include "batch/whole_file.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kTeapots = 8, kPictures = 3, kSceneResolution = 1024;

struct Row {
  const QuerySpec& query;
  const Answer& sampled;
  const Answer& exact;
};

std::string cell(const Answer& answer) {
  std::ostringstream text;
  text << std::left << std::setw(10) << nameOf(answer.result.status) << std::right << std::setw(9)
       << (std::isnan(answer.result.t) ? "-" : inDigits(answer.result.t)) << std::setw(8)
       << (answer.result.object == kNone ? "-" : std::to_string(answer.result.object));
  return text.str();
}

std::string tableOf(const std::vector<Row>& rows) {
  std::ostringstream text;
  text << "                    the paper's method (sampled)    exact (reference)\n"
       << "teapot              status            t  object     status            t  object   late by\n";
  for (const Row& row : rows) {
    const double late = row.sampled.result.t - row.exact.result.t;
    text << std::left << std::setw(20) << row.query.id << cell(row.sampled) << "     " << cell(row.exact) << std::right
         << std::setw(10) << (std::isnan(late) ? "-" : inDigits(late)) << "\n";
  }
  return text.str();
}

std::vector<Answer> answersIn(const Workload& workload, Mode mode, const AnsweringOptions& engine,
                              std::string& device) {
  AnsweringOptions options = engine;
  options.mode = mode;
  Answering answering(workload, options);
  answering.setUp();
  std::vector<Answer> answers = answering.run(nameOf(mode)).answers;
  if (answering.device()) device = answering.device()->name() + " (" + answering.device()->driver() + ")";
  return answers;
}

void writeAnswers(const std::filesystem::path& file, const Workload& workload, const std::vector<Answer>& answers) {
  std::string lines;
  for (size_t i = 0; i < answers.size(); ++i) {
    lines += answerLine(workload.queries[i], answers[i].result, answers[i].mode, answers[i].reason) + "\n";
  }
  writeWhole(file, lines);
}

/// The whole scene: R of a plate as large as the cube's diagonal that looks in from a corner.
void drawScene(const std::filesystem::path& file, Workload workload, uint32_t scene, const Device& device) {
  const double diagonal = std::sqrt(3.0) * kCubeSide;
  workload.meshes.push_back(makePlate(diagonal, diagonal, 0.01 * diagonal));
  QuerySpec query;
  query.scene = scene;
  // Columns: an orthonormal frame whose third axis looks from the corner into the cube.
  const double a = 1 / std::sqrt(2.0), b = 1 / std::sqrt(6.0), c = 1 / std::sqrt(3.0);
  const double back = 0.55 * diagonal * c;
  query.sensor = {static_cast<uint32_t>(workload.meshes.size() - 1),
                  {{a, -b, -c, back, -a, -b, -c, back, 0, 2 * b, -c, back}}};
  query.direction = {-c, -c, -c};
  query.distance = 1.2 * diagonal;
  ScenePlayer player(workload);
  player.show(scene);
  Sweeper sweeper(device, player.scene());
  const Scopes scopes = sweeper.scopes(toQuery(query, kSceneResolution));
  writeScopePicture(file, "The scene, seen from a corner of its cube", scopes,
                    {{"R of a plate that looks in: distance", "nothing there", &scopes.R, false}});
}

/// The scopes of the first few teapots that hit something.
std::vector<std::string> drawHits(const std::filesystem::path& folder, const std::vector<Row>& rows, Sweeper& sweeper) {
  std::vector<std::string> files;
  for (size_t i = 0; i < rows.size() && files.size() < kPictures; ++i) {
    if (rows[i].sampled.result.status != Status::hit) continue;
    const Scopes scopes = sweeper.scopes(toQuery(rows[i].query));
    const std::string name = "teapot-" + std::to_string(i) + ".png";
    writeScopePicture(folder / name,
                      rows[i].query.id + ":  d = " + inDigits(scopes.d) + ",  t = " + inDigits(scopes.result.t) +
                          ",  min(L) = " + inDigits(scopes.result.paperMinL),
                      scopes, panelsOf(scopes));
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
  const std::vector<Answer> sampled = answersIn(workload, Mode::sampled, engine, deviceName);
  const std::vector<Answer> exact = answersIn(workload, Mode::reference, engine, deviceName);
  std::vector<Row> rows;
  for (size_t i = 0; i < sampled.size(); ++i) rows.push_back({workload.queries[i], sampled[i], exact[i]});
  const std::string table = tableOf(rows);
  std::cout << table << "\nobjects below " << settings.boxes << " are boxes, the others teapots; sampled on "
            << deviceName << "\n";
  writeWhole(folder / "table.txt", table);
  writeAnswers(folder / "answers-sampled.jsonl", workload, sampled);
  writeAnswers(folder / "answers-reference.jsonl", workload, exact);

  const uint32_t scene = workload.queries.front().scene;
  const Device device = Device::open({.index = engine.device});
  ScenePlayer player(workload);
  player.show(scene);
  Sweeper sweeper(device, player.scene());
  std::string pictures = "scene.png";
  for (const std::string& name : drawHits(folder, rows, sweeper)) pictures += ", " + name;
  drawScene(folder / "scene.png", workload, scene, device);

  std::cout << "\nIn " << std::filesystem::absolute(folder).string() << ":\n  pictures   " << pictures
            << "\n  answers    table.txt, answers-sampled.jsonl, answers-reference.jsonl\n  questions  "
            << file.filename().string() << "; try: cyber-radar query " << file.string() << "\n";
  const bool someInvalid = std::any_of(rows.begin(), rows.end(),
                                       [](const Row& row) { return row.sampled.result.status == Status::invalid; });
  return someInvalid ? kStatusSomeInvalid : 0;
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
