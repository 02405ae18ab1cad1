// Fuzzes a Sweeper: an input is a sequence of edits of a scene and of batches of queries, which the device answers as
// the CPU does.
#include "fuzz/check_answers.h"
#include "fuzz/scene_calls.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"
#include "radar/radar.h"
#include "support/answer.h"
#include "support/test_device.h"

namespace radar::fuzz {

namespace {

void ask(Choices& choices, SceneCalls& calls, Sweeper& sweeper) {
  const Mode mode = choices.oneIn(3) ? Mode::sampled : Mode::contact;
  std::vector<Query> queries = calls.queries(4);
  const auto isInvalid = [&](const Query& query) { return !validate(query, calls.scene(), mode).empty(); };
  leaveValid(queries, isInvalid, [&](const auto& all) { sweeper.run(all, mode); });
  const Answers found = sweeper.run(queries, mode);
  Answers expected = CpuSweeper(calls.scene(), 1).run(queries);
  for (size_t i = 0; mode == Mode::sampled && i < queries.size(); ++i) {
    checkSampled(found.results[i], expected.results[i], test::reasonFor(found, i));
    expected.results[i] = found.results[i];
  }
  requireSame(found, expected);
}

void run(std::string_view input) {
  Choices choices(input);
  SceneCalls calls(choices);
  Sweeper sweeper(test::device(), calls.scene(), {.cpuBatch = choices.below(3)});
  for (int i = 0; i < 40 && !choices.areOver(); ++i) {
    if (choices.oneIn(4)) {
      ask(choices, calls, sweeper);
    } else {
      calls.edit();
    }
  }
  for (const std::string& message : test::takeValidationMessages()) require(false, "validation: " + message);
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, [] { return randomSeeds(32, 400); }, {}};
  return kTarget;
}

}  // namespace radar::fuzz
