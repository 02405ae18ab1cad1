#include <algorithm>
#include <bit>
#include <iostream>
#include <nlohmann/json.hpp>

#include "batch/answer_file.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/answer_page.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"
#include "measure/report.h"
#include "workloads/query_fields.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar scopes batch.json --query ring/0 --out pictures
  cyber-radar scopes ring.obj peg.stl --direction 0 0 1 --distance 8 --out pictures --raw

Writes scopes.html, a page with the three pictures and the scene. With --raw also R.f32, M.f32 and L.f32: the values as
little-endian 32-bit floats, row by row from the window's lower left corner, NaN where a pixel has no value; and
scopes.json, which gives width, height, the side of a pixel, d, the sensor's length along the motion, the window's
corner and axes in the world, and the answer.)";

struct Options {
  std::vector<std::string> files;
  std::string query, out;
  SweepOptions sweep;
  std::vector<NamedOption> motion;
  EngineOptions engine;
  bool raw = false;
};

Workload load(Options& options) {
  if (options.files.size() == 2) {
    if (!options.query.empty()) throw InputError("--query", "", "expected one query file, got two files");
    options.sweep.scene = options.files[0];
    options.sweep.sensor = options.files[1];
    return options.sweep.load();
  }
  if (options.query.empty()) throw InputError("--query", "", "expected the id of a query of the file, got none");
  for (const auto& [name, option] : options.motion) {
    if (option.given()) throw InputError(name, "", "expected no such option beside a query file, which says it");
  }
  std::vector<std::string> warnings;
  Outputs outputs;
  outputs.addIn("--out", options.out, {"scopes.html", "scopes.json", "R.f32", "M.f32", "L.f32"});
  Workload workload = QueryFile(options.files[0], warnings, outputs).all();
  printWarnings(warnings);
  return workload;
}

const QuerySpec& findQuery(const Workload& workload, const Options& options) {
  if (options.query.empty()) return workload.queries.front();
  const auto found = std::find_if(workload.queries.begin(), workload.queries.end(),
                                  [&](const QuerySpec& query) { return query.id == options.query; });
  if (found == workload.queries.end()) {
    throw InputError(options.files[0], "queries", "expected a query with the id \"" + options.query + "\", got none");
  }
  return *found;
}

void writeRaw(const std::filesystem::path& folder, const Workload& workload, const QuerySpec& query,
              const Scopes& scopes) {
  static_assert(std::endian::native == std::endian::little);
  for (const auto& [name, values] :
       {std::pair{"R.f32", &scopes.R}, std::pair{"M.f32", &scopes.M}, std::pair{"L.f32", &scopes.L}}) {
    writeAtomically(folder / name, {reinterpret_cast<const char*>(values->data()), 4 * values->size()});
  }
  nlohmann::ordered_json sidecar;
  sidecar["width"] = scopes.width;
  sidecar["height"] = scopes.height;
  sidecar["pixel"] = scopes.pixel;
  sidecar["d"] = scopes.d;
  sidecar["length"] = scopes.length;
  sidecar["origin"] = scopes.origin;
  sidecar["right"] = scopes.right;
  sidecar["up"] = scopes.up;
  sidecar["forward"] = scopes.forward;
  sidecar["answer"] = nlohmann::ordered_json::parse(answerLine(
      query, {.result = scopes.result, .mode = AnswerMode::sampled}, {.objects = workload.objectNames(query.scene)}));
  writeAtomically(folder / "scopes.json", sidecar.dump(2) + "\n");
}

void drawScopes(Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  Workload workload = load(options);
  // The text below needs the whole answer, and the pictures are of mode sampled.
  const QuerySpec& wanted = findQuery(workload, options);
  for (const auto& [name, isGiven] :
       {std::pair{"turn", wanted.turn.has_value()}, {"chain", wanted.chain.has_value()}}) {
    if (!isGiven) continue;
    throw InputError(options.files[0], name,
                     std::string("expected a straight motion, along which scopes look, got a ") + name);
  }
  if (const MeshData& sensor = workload.meshes[wanted.mesh]; sensor.radius > 0) {
    throw InputError(sensor.name, "", "expected a sensor without a radius, of which scopes are pictures");
  }
  workload.queries = {sampledPartOf(wanted)};
  workload.queries.front().anyHit = false;
  const QuerySpec& query = workload.queries.front();
  ScenePlayer player(workload);
  player.show(query.scene);
  const Device device = Device::open({.index = engine.device});
  Sweeper sweeper(device, player.scene());
  Query asked = query;
  asked.resolution = engine.resolution;
  const Scopes scopes = sweeper.scopes(asked);
  if (scopes.result.status == Status::invalid) {
    throw std::runtime_error("query " + query.id + ": expected an answer, the device gave none");
  }
  makeFolder("--out", options.out);
  const std::filesystem::path folder = options.out;
  const std::string title = query.id + ":  d = " + inDigits(scopes.d) + ",  D = " + inDigits(query.distance) +
                            ",  min(L) = " + leastFreeDistance(scopes) + ",  " + std::to_string(scopes.width) + " x " +
                            std::to_string(scopes.height) + " pixels of " + inDigits(scopes.pixel);
  const Answer answer{scopes.result, AnswerMode::sampled, {}, {}};
  const std::string page = (folder / "scopes.html").string();
  writePage(page, query.id, workload, {&answer, 1}, {.device = &device});
  if (options.raw) writeRaw(folder, workload, query, scopes);
  std::cout << title << "\n"
            << inWords(workload, query, answer) << "page: " << page
            << (options.raw ? "; values: R.f32, M.f32, L.f32, scopes.json" : "") << "\n";
}

}  // namespace

void addScopesCommand(Program& program) {
  Command command = program.add("scopes", "Shows the paper's scopes R, M and L of one query", kExamples);
  auto options = std::make_shared<Options>();
  command.option("FILES", &options->files, "A query file; or two mesh files, scene and sensor").required().count(1, 2);
  command.option("--query", &options->query, "Which query of the query file").value("ID");
  command.option("--out", &options->out, "Folder for the page").required().value("DIR");
  options->motion = options->sweep.addMotionTo(command);
  options->engine.addResolutionTo(command);
  command.option("--raw", &options->raw, "Writes the 32-bit values too");
  command.run([options] {
    drawScopes(*options);
    return 0;
  });
}

}  // namespace radar::tools
