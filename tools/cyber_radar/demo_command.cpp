#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "batch/answer_rows.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/canvas.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/flight.h"
#include "cyber_radar/options.h"
#include "cyber_radar/scene_picture.h"
#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kTeapots = 12, kPictures = 3;
constexpr uint32_t kStep = 1;  // the only step's scene
constexpr uint32_t kResolution = 1024;
constexpr double kMargin = 16, kCaption = 44;
constexpr Colour kPath{0.75, 0.15, 0.10};

struct Row {
  const QuerySpec& query;
  const Answer& sampled;
  const Answer& exact;
};

std::string number(double value, const char* format) {
  if (!std::isfinite(value)) return "-";
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

std::vector<Answer> answersIn(const Workload& workload, AnswerMode mode, AnsweringOptions engine) {
  engine.mode = mode;
  Answering answering(workload, modesOf(workload), engine);
  return answersTo(workload, answering, nameOf(mode));
}

/// A line as long as a teapot can fly, with a dot where it touches something.
void drawWay(const Canvas& canvas, const Scopes& view, const MeshData& teapot, const Row& row) {
  const Transform& pose = row.query.worldFromMesh;
  const Vec3 start = turned(linearPart(pose), extentOf(teapot).middle) + Vec3{pose.m[3], pose.m[7], pose.m[11]};
  const bool touches = row.exact.result.status != Status::clear;
  const double distance = touches ? row.exact.result.t : row.query.distance;
  const Vec3 end = start + (distance / lengthOf(row.query.direction)) * row.query.direction;
  const auto [x0, y0] = pixelOf(view, start, kMargin);
  const auto [x1, y1] = pixelOf(view, end, kMargin);
  canvas.colour(kPath);
  cairo_set_line_width(canvas.get(), 2.5);
  cairo_move_to(canvas.get(), x0, y0);
  cairo_line_to(canvas.get(), x1, y1);
  cairo_stroke(canvas.get());
  if (!touches) return;
  cairo_arc(canvas.get(), x1, y1, 5.5, 0, 2 * std::acos(-1.0));
  cairo_fill(canvas.get());
}

/// The teapots are coloured.
void drawScene(const std::filesystem::path& file, const Workload& workload, const std::vector<Row>& rows,
               const Device& device) {
  Workload stage = workload;
  const auto disc = static_cast<uint32_t>(stage.meshes.size()), moving = static_cast<uint32_t>(stage.scenes.size());
  stage.meshes.push_back(viewingDisc(kCubeSide));
  stage.scenes.push_back({"what moves", {}, stage.scenes[kStep].instances, {}});
  ScenePlayer player(stage);
  Sweeper sweeper(device, player.scene());
  player.show(kStep);
  const Scopes all = sweeper.scopes(viewOf(disc, kCubeSide, kResolution));
  player.show(moving);
  const Scopes movers = sweeper.scopes(viewOf(disc, kCubeSide, kResolution));

  const Canvas canvas(2 * kMargin + all.width, 2 * kMargin + all.height + kCaption);
  drawSurfaces(canvas, kMargin, kCubeSide, all, movers);
  for (const Row& row : rows) drawWay(canvas, all, workload.meshes[row.query.mesh], row);
  canvas.text(kMargin, kMargin + all.height + 20, 15,
              "The scene as the method sees it: the depth picture R of a disc that looks in from a corner, shaded.");
  canvas.text(kMargin, kMargin + all.height + 40, 15,
              "Orange: what flies. A line shows how far each gets, a dot that something is touched there.");
  canvas.write(file);
}

/// Draws the scopes of the first few teapots that hit something. Returns the files' names, each after a comma.
std::string drawHits(const std::filesystem::path& folder, const Workload& workload, const std::vector<Row>& rows,
                     const Device& device) {
  ScenePlayer player(workload);
  player.show(kStep);
  Sweeper sweeper(device, player.scene());
  std::string files;
  for (uint32_t i = 0, drawn = 0; i < rows.size() && drawn < kPictures; ++i) {
    if (rows[i].sampled.result.status != Status::hit) continue;
    const Scopes scopes = sweeper.scopes(rows[i].query);
    const std::string name = "teapot-" + std::to_string(i) + ".png";
    const std::string title = rows[i].query.id + ":  d = " + inDigits(scopes.d) + ",  t = " + inDigits(scopes.result.t);
    writeScopePicture(folder / name, title + ",  min(L) = " + leastFreeDistance(scopes), scopes);
    files += ", " + name;
    ++drawn;
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

  const Device device = Device::open({.index = engine.device});
  const std::vector<Answer> sampled = answersIn(workload, AnswerMode::sampled, engine);
  const std::vector<Answer> exact = answersIn(workload, AnswerMode::reference, engine);
  std::vector<Row> rows;
  for (size_t i = 0; i < sampled.size(); ++i) rows.push_back({workload.queries[i], sampled[i], exact[i]});
  const std::string table = tableOf(rows);
  std::cout << table << "\nobjects below " << settings.boxes << " are boxes, the others teapots; sampled on "
            << device.name() << " (" << device.driver() << ")\n";
  writeAtomically(folder / "table.txt", table);
  AnswerRows lines(workload, AnswerFormat::lines);
  writeAtomically(folder / "answers-sampled.jsonl", lines.text(0, workload.queries, sampled));
  writeAtomically(folder / "answers-reference.jsonl", lines.text(0, workload.queries, exact));

  drawScene(folder / "scene.png", workload, rows, device);
  const std::string pictures = "scene.png" + drawHits(folder, workload, rows, device);

  const Flight flight = fly();
  const std::string happened = tableOf(flight);
  std::cout << "\nNow teapots fly at once, each towards another, for one step; what touches something stays there.\n\n"
            << happened;
  writeAtomically(folder / "flight.txt", happened);
  drawFlight(flight, device, folder / "flight", folder / "flight.png");

  std::cout << "\nIn " << std::filesystem::absolute(folder).string() << ":\n  pictures   " << pictures
            << "\n  film       flight.png, which browsers play; its pictures are in flight\n  answers    table.txt, "
               "flight.txt, answers-sampled.jsonl, answers-reference.jsonl\n  questions  "
            << file.filename().string() << "; try: cyber-radar query " << file.string() << "\n";
  return someInvalid(sampled) ? kStatusSomeInvalid : 0;
}

}  // namespace

void addDemoCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "demo",
      "The paper's teapots among boxes: tables of answers, pictures of the scene and of R, M and L, and a film");
  auto out = std::make_shared<std::string>("cyber-radar-demo");
  auto engine = std::make_shared<EngineOptions>();
  command->add_option("--out", *out, "Folder for everything")->type_name("DIR")->capture_default_str();
  engine->addResolutionTo(*command);
  command->callback([out, engine, &status] { status = demonstrate(*out, engine->checked()); });
}

}  // namespace radar::tools
