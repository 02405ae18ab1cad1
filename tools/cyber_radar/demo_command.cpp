#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "batch/answer_file.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/canvas.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kTeapots = 12, kPictures = 3;
constexpr uint32_t kStep = 1;  // the only step's scene
constexpr uint32_t kResolution = 1024;
constexpr double kMargin = 16, kCaption = 44;
constexpr Colour kStill{0.55, 0.62, 0.70}, kMoving{0.90, 0.45, 0.05}, kPath{0.75, 0.15, 0.10};
constexpr Vec3 kLight{-0.4, 0.6, -0.69};  // towards the light: from the left, above and the viewer

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
  Answering answering(workload, engine);
  answering.setUp();
  return answering.run(nameOf(mode)).answers;
}

/// A disc that covers the cube, seen from a corner, and looks to the opposite one.
Query viewOf(uint32_t discMesh) {
  const double a = 1 / std::sqrt(2.0), b = 1 / std::sqrt(6.0), c = 1 / std::sqrt(3.0);
  const double diagonal = kCubeSide / c, back = 0.55 * diagonal * c;
  Query query;
  query.mesh = discMesh;
  // The columns of the rotation are orthonormal; the third is the disc's axis.
  query.worldFromMesh = {{a, -b, -c, back, -a, -b, -c, back, 0, 2 * b, -c, back}};
  query.direction = {-c, -c, -c};
  query.distance = 1.1 * diagonal;
  query.mode = Mode::sampled;
  query.resolution = kResolution;
  return query;
}

/// The slope of the depth across a pixel, on the side where it is less, so that an edge in depth is not a slope.
double slope(const std::vector<float>& depth, size_t before, size_t here, size_t after, double pixel) {
  const double down = depth[here] - depth[before], up = depth[after] - depth[here];
  if (std::isnan(down)) return std::isnan(up) ? 0 : up / pixel;
  if (std::isnan(up)) return down / pixel;
  return (std::abs(down) < std::abs(up) ? down : up) / pixel;
}

void drawSurfaces(const Canvas& canvas, const Scopes& all, const Scopes& moving) {
  const auto& depth = all.R;
  for (uint32_t row = 1; row + 1 < all.height; ++row) {
    for (uint32_t column = 1; column + 1 < all.width; ++column) {
      const size_t here = size_t{row} * all.width + column;
      if (std::isnan(depth[here])) continue;
      const double x = slope(depth, here - 1, here, here + 1, all.pixel);
      const double y = slope(depth, here - all.width, here, here + all.width, all.pixel);
      const Vec3 normal{x, y, -1};  // towards the viewer
      const double light = std::max(0.0, dot(normal, kLight)) / lengthOf(normal);
      // Far surfaces fade, so that near ones stand out.
      const double fade = 0.5 * std::min(1.0, depth[here] / (1.9 * kCubeSide));
      const bool moves = std::abs(moving.R[here] - depth[here]) < all.pixel;
      const Colour& base = moves ? kMoving : kStill;
      const Vec3 lit = (0.45 + 0.75 * light) * base;
      canvas.colour(moves ? lit : lit + fade * (kFull - lit));
      canvas.fill(kMargin + column, kMargin + all.height - 1 - row, 1, 1);
    }
  }
}

/// A line as long as a teapot can fly, with a dot where it touches something.
void drawFlight(const Canvas& canvas, const Scopes& view, const MeshData& teapot, const Row& row) {
  const Transform& pose = row.query.sensor.worldFromMesh;
  const Vec3 start = turned(linearPart(pose), extentOf(teapot).middle) + Vec3{pose.m[3], pose.m[7], pose.m[11]};
  const bool touches = row.exact.result.status != Status::clear;
  const double distance = touches ? row.exact.result.t : row.query.distance;
  const Vec3 end = start + (distance / lengthOf(row.query.direction)) * row.query.direction;
  const auto pixelOf = [&](const Vec3& p) {
    const Vec3 offset = p - view.origin;
    return std::pair(kMargin + dot(offset, view.right) / view.pixel,
                     kMargin + view.height - dot(offset, view.up) / view.pixel);
  };
  const auto [x0, y0] = pixelOf(start);
  const auto [x1, y1] = pixelOf(end);
  canvas.colour(kPath);
  cairo_set_line_width(canvas.get(), 2.5);
  cairo_move_to(canvas.get(), x0, y0);
  cairo_line_to(canvas.get(), x1, y1);
  cairo_stroke(canvas.get());
  if (!touches) return;
  cairo_arc(canvas.get(), x1, y1, 5.5, 0, 2 * std::acos(-1.0));
  cairo_fill(canvas.get());
}

/// Draws the scene as the method itself sees it: R of a disc that looks in from a corner, shaded by its slope. The
/// teapots are coloured.
void drawScene(const std::filesystem::path& file, const Workload& workload, const std::vector<Row>& rows,
               const Device& device) {
  Workload stage = workload;
  const auto disc = static_cast<uint32_t>(stage.meshes.size()), moving = static_cast<uint32_t>(stage.scenes.size());
  stage.meshes.push_back(makeRod(0.5 * std::sqrt(8.0 / 3) * kCubeSide + 1, 1, 48));
  stage.scenes.push_back({"what moves", {}, stage.scenes[kStep].instances, {}});
  ScenePlayer player(stage);
  Sweeper sweeper(device, player.scene());
  player.show(kStep);
  const Scopes all = sweeper.scopes(viewOf(disc));
  player.show(moving);
  const Scopes movers = sweeper.scopes(viewOf(disc));

  const Canvas canvas(2 * kMargin + all.width, 2 * kMargin + all.height + kCaption);
  drawSurfaces(canvas, all, movers);
  for (const Row& row : rows) drawFlight(canvas, all, workload.meshes[row.query.sensor.mesh], row);
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
    const Scopes scopes = sweeper.scopes(toQuery(rows[i].query, Mode::sampled));
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
  writeAtomically(folder / "answers-sampled.jsonl", answerLines(workload, sampled));
  writeAtomically(folder / "answers-reference.jsonl", answerLines(workload, exact));

  drawScene(folder / "scene.png", workload, rows, device);
  const std::string pictures = "scene.png" + drawHits(folder, workload, rows, device);

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
