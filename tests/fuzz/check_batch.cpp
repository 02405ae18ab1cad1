#include "fuzz/check_batch.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "batch/answer_file.h"
#include "fuzz/check_answers.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"
#include "support/answer.h"

namespace radar::fuzz {

using namespace tools;

void checkMessage(const std::string& file, const std::string& words) {
  const auto isControl = [](char c) { return (c >= 0 && c < 32) || c == 127; };
  require(words.starts_with(file + ": "), "a message that does not name the file: " + words);
  require(words.size() < 4000 && std::ranges::none_of(words, isControl), "a message that cannot be printed");
}

void checkBatch(const tools::Workload& workload) {
  ScenePlayer player(workload);
  CpuSweeper sweeper(player.scene(), 1);
  for (const Batch& batch : batchesOf(workload.queries)) {
    player.show(batch.scene);
    for (const uint32_t number : batch.numbers) {
      const QuerySpec& spec = workload.queries[number];
      const Mode mode = spec.mode == AnswerMode::sampled ? Mode::sampled : Mode::contact;
      const std::string wrong = validate(spec, player.scene(), mode);
      // Readers leave it to the engine what the sensor's size allows.
      if (wrong.starts_with("slack: expected at most a tenth")) return;
      require(wrong.empty(), "a query that breaks its contract: " + wrong);
    }
    const Answers answers = sweeper.run(batch.queries);
    checkAnswers(player.scene(), batch.queries, answers);
    const std::vector<std::string> names = workload.objectNames(batch.scene);
    for (size_t i = 0; i < batch.queries.size(); ++i) {
      const QuerySpec& spec = workload.queries[batch.numbers[i]];
      const Answer answer{answers.results[i], AnswerMode::reference, "", test::listedBy(answers, i)};
      const std::string line = answerLine(spec, answer, names);
      const nlohmann::json read = nlohmann::json::parse(line);
      require(line.find('\n') == line.npos && read["status"] == nameOf(answers.results[i].status),
              "a broken line: " + line);
      const bool hasTime = read["t"].is_number();
      require(!hasTime || (read["lo"] <= read["t"] && read["t"] <= read["hi"]), "bounds in disorder: " + line);
    }
  }
}

}  // namespace radar::fuzz
