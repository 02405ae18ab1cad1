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
  try {
    follower.run(queries);
    require(std::ranges::none_of(queries, isInvalid), "an invalid query is answered");
  } catch (const Error&) {
    require(std::erase_if(queries, isInvalid) > 0, "a valid query is refused");
  }
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
