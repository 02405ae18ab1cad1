// Fuzzes the public interface without a device: an input is a sequence of edits of a scene and of batches of queries,
// which the CPU answers.
#include "fuzz/check_answers.h"
#include "fuzz/scene_calls.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"

namespace radar::fuzz {

namespace {

void ask(SceneCalls& calls, CpuSweeper& follower) {
  std::vector<Query> queries = calls.queries(4);
  const size_t count = queries.size();
  const auto isInvalid = [&](const Query& query) { return !validate(query, calls.scene()).empty(); };
  leaveValid(queries, isInvalid, [&](const auto& all) { follower.run(all); });
  const Answers answers = follower.run(queries);
  checkAnswers(calls.scene(), queries, answers);
  // A new sweeper gives the same bits as one that has followed the scene, and another number of threads, too.
  requireSame(answers, CpuSweeper(calls.scene(), 1 + count % 2).run(queries));
}

void run(std::string_view input) {
  Choices choices(input);
  SceneCalls calls(choices);
  CpuSweeper follower(calls.scene(), 1);
  for (int i = 0; i < 60 && !choices.areOver(); ++i) {
    if (choices.oneIn(4)) {
      ask(calls, follower);
    } else {
      calls.edit();
    }
  }
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, [] { return randomSeeds(64, 600); }, {}};
  return kTarget;
}

}  // namespace radar::fuzz
