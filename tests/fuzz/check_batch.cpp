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

namespace {

void checkLine(const QuerySpec& query, const Answer& answer, const AnswerNames& names) {
  const std::string line = answerLine(query, answer, names);
  const nlohmann::json read = nlohmann::json::parse(line);
  require(line.find('\n') == line.npos && read["status"] == nameOf(answer.result.status), "a broken line: " + line);
  const bool hasTime = read["t"].is_number();
  require(!hasTime || (read["lo"] <= read["t"] && read["t"] <= read["hi"]), "bounds in disorder: " + line);
}

/// Of a chain: what was read keeps its contract, or the sweeper throws.
void checkMoves(const Workload& workload, const Batch& batch, const Scene& scene) {
  const ChainSpec& chain = workload.chains[*batch.chain];
  const std::vector<ChainResult> moves = ChainSweeper(scene, chain, 1).run(batch.moves);
  for (size_t i = 0; i < moves.size(); ++i) {
    const auto& [contact, link, mesh, otherLink, otherMesh] = moves[i];
    require(contact.status != Status::invalid, "an answer that is invalid");
    require((link != kNone) == (contact.object != kNone || otherLink != kNone), "a contact without its link");
    checkLine(workload.queries[batch.numbers[i]], {.result = contact, .links = {link, mesh, otherLink, otherMesh}},
              {.objects = workload.objectNames(batch.scene), .links = chain.linkNames});
  }
}

}  // namespace

void checkBatch(const tools::Workload& workload) {
  ScenePlayer player(workload);
  CpuSweeper sweeper(player.scene(), 1);
  for (const Batch& batch : batchesOf(workload.queries)) {
    player.show(batch.scene);
    if (batch.chain) {
      checkMoves(workload, batch, player.scene());
      continue;
    }
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
    const AnswerNames names{.objects = workload.objectNames(batch.scene)};
    for (size_t i = 0; i < batch.queries.size(); ++i) {
      checkLine(workload.queries[batch.numbers[i]],
                {answers.results[i], AnswerMode::reference, "", test::listedBy(answers, i)}, names);
    }
  }
}

}  // namespace radar::fuzz
