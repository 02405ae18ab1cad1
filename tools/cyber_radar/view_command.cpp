#include <cstdio>
#include <filesystem>
#include <iostream>

#include "batch/answer_reader.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/answer_page.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "view/gltf.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar view batch.json --out view.html                 answers the queries first
  cyber-radar view batch.json answers.jsonl --out view.html   answers of cyber-radar query
  cyber-radar view batch.json --gltf view.glb                 for Blender

The page is one file, which any browser shows without a network: the scene, each sensor where it stops, and a table.)";

struct Options {
  std::string file, answers, out, gltf, title;
  EngineOptions engine;
};

std::string inMegabytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
  return text;
}

int view(const Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  Outputs outputs;
  if (options.out.empty() && options.gltf.empty()) throw InputError("--out", "", "expected it, or --gltf, got neither");
  if (!options.out.empty()) outputs.add("--out", options.out);
  if (!options.gltf.empty()) outputs.add("--gltf", options.gltf);
  if (!options.answers.empty()) outputs.requireNone(options.answers);
  std::vector<std::string> warnings;
  const Workload workload = QueryFile(options.file, warnings, outputs).all();
  printWarnings(warnings);
  std::vector<Answer> answers;
  std::optional<Answering> answering;
  const Device* device = nullptr;
  if (options.answers.empty()) {
    answering.emplace(workload, modesOf(workload), engine);
    try {
      answers = answersTo(workload, *answering, "answering");
    } catch (const RefusedQuery& query) {
      throw InputError(printable(options.file) + ": " + query.what());
    }
    const std::span<const Device> devices = answering->answerer().devices();
    if (!devices.empty()) device = &devices[0];
  } else {
    answers = readAnswers(options.answers, workload);
  }
  const auto say = [&](const std::string& file) {
    std::cout << file << ": " << counted(workload.queries.size(), "query", "queries") << ", "
              << counted(workload.scenes.size(), "scene") << ", " << inMegabytes(std::filesystem::file_size(file))
              << "\n";
  };
  if (!options.out.empty()) {
    writePage(options.out, options.title.empty() ? options.file : options.title, workload, answers, {.device = device});
    say(options.out);
  }
  if (!options.gltf.empty()) {
    const Gltf scene = gltfOf(workload, resultsOf(answers), leftOutOf(answers));
    writeAtomically(options.gltf, scene.bytes);
    say(options.gltf);
    printWarnings(scene.notes);
  }
  return someInvalid(answers) ? kStatusSomeInvalid : 0;
}

}  // namespace

void addViewCommand(Program& program) {
  Command command = program.add("view", "Shows answers: a page that any browser opens", kExamples);
  auto options = std::make_shared<Options>();
  command.option("FILE.json", &options->file, "Query file").required();
  command.option("ANSWERS", &options->answers,
                 "Its answers, as cyber-radar query --out wrote them; else they are found now");
  command.option("--out", &options->out, "Where the page goes").value("FILE.html");
  command.option("--gltf", &options->gltf, "Writes an animated scene for Blender and others here, as glTF 2.0")
      .value("FILE.glb");
  const Option title =
      command.option("--title", &options->title, "Of the page; else the query file's name").value("TEXT");
  const std::vector<NamedOption> engine = options->engine.addTo(command);
  command.run([=] {
    for (const auto& [name, option] : engine) {
      if (options->answers.empty() || !option.given()) continue;
      throw InputError(name, "", "expected it only where answers are to be found, got " + options->answers + ", too");
    }
    if (options->out.empty() && title.given()) {
      throw InputError("--title", "", "expected it with --out, whose page it names");
    }
    return view(*options);
  });
}

}  // namespace radar::tools
