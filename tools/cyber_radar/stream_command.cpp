#include <unistd.h>

#include <exception>
#include <iostream>

#include "batch/answer_rows.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/line_input.h"
#include "cyber_radar/query_run.h"
#include "cyber_radar/words.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar stream cell.json < queries.jsonl > answers.jsonl
  planner | cyber-radar stream cell.json --mode contact | controller

FILE.json is a query file with meshes and scenes; its own queries, which may be none, are answered first. Each line of
standard input is one query, an object as in "queries"; ids may be repeated. Each line of standard output is its answer, in
the same order. Whatever lines are there are answered in one batch, so a single query is answered at once, and a fast writer
gets the speed of large batches. A bad line ends the program with exit status 2, once those before it are answered.)";

struct Options {
  std::string file;
  EngineOptions engine;
};

/// Answers queries to standard output.
class Stream {
 public:
  Stream(const QueryFile& file, const AnsweringOptions& engine)
      : file_(file), mode_(engine.mode), answering_(file.world(), asked(file), engine) {
    // Whoever waits for the first answer does not wait for the device.
    if (file.world().scenes.empty()) {
      answering_.open();
    } else {
      answering_.setUp(0);
    }
  }

  void answerFile() {
    answerRange(file_, 0, file_.count(), answering_, "answering",
                [&](uint64_t, auto queries, std::span<const Answer> answers) { write(queries, answers); });
  }
  void answer(LineInput& input) {
    for (std::vector<std::string> lines; !(lines = input.next()).empty();) {
      std::vector<QuerySpec> queries;
      std::exception_ptr refused;
      try {
        for (size_t i = 0; i < lines.size(); ++i) queries.push_back(read(input.placeOf(i), lines[i]));
      } catch (...) {
        refused = std::current_exception();
      }
      for (bool isDone = false; !isDone;) {
        try {
          Progress none;
          write(queries, answering_.run(queries, none));
          isDone = true;
        } catch (const RefusedQuery& query) {
          refused = std::make_exception_ptr(InputError(input.placeOf(query.index), "", query.problem));
          queries.resize(query.index);
        }
      }
      if (refused) std::rethrow_exception(refused);
    }
  }
  const AnsweringStats& stats() const { return answering_.stats(); }

 private:
  // Lines may leave the mode to the command.
  static ModesAsked asked(const QueryFile& file) {
    ModesAsked asked = file.modes();
    asked.modes.try_emplace(std::nullopt);
    return asked;
  }
  QuerySpec read(const std::string& place, const std::string& line) const {
    QuerySpec query = file_.query(place, line);
    const std::string reason = exactOnly(file_.world(), query);
    if (mode_ == AnswerMode::sampled && !query.mode && !reason.empty()) {
      throw InputError(place, "", "expected the mode contact or reference, as " + reason + " needs, got none");
    }
    return query;
  }
  void write(std::span<const QuerySpec> queries, std::span<const Answer> answers) {
    std::cout << rows_.text(0, queries, answers) << std::flush;
    if (!std::cout) throw std::runtime_error("standard output: expected a place to write to, got an error");
  }

  const QueryFile& file_;
  AnswerMode mode_;
  Answering answering_;
  AnswerRows rows_{file_.world(), AnswerFormat::lines};
};

int stream(const Options& options) {
  const AnsweringOptions engine = options.engine.checked();
  if (options.file == "-")
    throw InputError("FILE.json", "", "expected a file, as standard input has the queries, got -");
  std::vector<std::string> warnings;
  const QueryFile file(options.file, warnings);
  printWarnings(warnings);
  Stream stream(file, engine);
  stream.answerFile();
  LineInput input(STDIN_FILENO, "standard input");
  stream.answer(input);
  uint64_t answered = 0;
  for (const uint64_t count : stream.stats().statuses) answered += count;
  std::cerr << "cyber-radar: answered " << counted(answered, "query", "queries") << " in "
            << counted(stream.stats().batches, "batch", "batches") << statusesInWords(stream.stats()) << "\n";
  return stream.stats().statuses[static_cast<size_t>(Status::invalid)] > 0 ? kStatusSomeInvalid : 0;
}

}  // namespace

void addStreamCommand(Program& program) {
  Command command = program.add("stream", "Answers queries as they come, one JSON line each", kExamples);
  auto options = std::make_shared<Options>();
  command.option("FILE.json", &options->file, "Query file with the meshes and scenes").required();
  options->engine.severalDevices = true;
  options->engine.addTo(command);
  command.run([options] { return stream(*options); });
}

}  // namespace radar::tools
