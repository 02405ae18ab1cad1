#include <filesystem>
#include <iostream>

#include "batch/answer_reader.h"
#include "batch/query_file.h"
#include "cyber_radar/answer_page.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar view batch.json --out view.html                 answers the queries first
  cyber-radar view batch.json answers.jsonl --out view.html   answers of cyber-radar query

The page is one file, which any browser shows without a network: the scene, each sensor where it stops, and a table.)";

struct Options {
  std::string file, answers, out;
  EngineOptions engine;
};

int view(const Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  Outputs outputs;
  outputs.add("--out", options.out);
  if (!options.answers.empty()) outputs.requireNone(options.answers);
  std::vector<std::string> warnings;
  const Workload workload = QueryFile(options.file, warnings, outputs).all();
  printWarnings(warnings);
  std::vector<Answer> answers;
  std::optional<Answering> answering;
  const Device* device = nullptr;
  if (options.answers.empty()) {
    answering.emplace(workload, modesOf(workload), engine);
    answers = answersTo(workload, *answering, "answering");
    const std::span<const Device> devices = answering->answerer().devices();
    if (!devices.empty()) device = &devices[0];
  } else {
    answers = readAnswers(options.answers, workload);
  }
  writePage(options.out, options.file, workload, answers, {.device = device});
  std::cout << options.out << ": " << counted(workload.queries.size(), "query", "queries") << ", "
            << counted(workload.scenes.size(), "scene") << ", "
            << (std::filesystem::file_size(options.out) + 99'999) / 100'000 * 0.1 << " MB\n";
  return someInvalid(answers) ? kStatusSomeInvalid : 0;
}

}  // namespace

void addViewCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("view", "Shows answers: a page that any browser opens");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("FILE.json", options->file, "Query file")->required();
  command->add_option("ANSWERS", options->answers,
                      "Its answers, as cyber-radar query --out wrote them; else they are found now");
  command->add_option("--out", options->out, "Where the page goes")->required()->type_name("FILE.html");
  options->engine.addTo(*command);
  command->callback([options, &status] { status = view(*options); });
}

}  // namespace radar::tools
