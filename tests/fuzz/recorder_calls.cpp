// Fuzzes a Recorder: an input is a capacity and a sequence of edits of a scene and of recordings. Each answer is the
// CPU's, or its flag says which limit was too small; with the capacity that needed() gives, all are answered.
#include "fuzz/check_recorded.h"
#include "fuzz/scene_calls.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"
#include "support/test_device.h"

namespace radar::fuzz {

namespace {

Capacity capacityFrom(Choices& choices) {
  if (choices.oneIn(16)) {
    return {.queries = choices.of(std::array{1u, ~0u}),
            .candidates = choices.of(std::array{1u, 1u << 31}),
            .rounds = choices.of(std::array{0u, 1u, 2u, 3u, 66u, ~0u}),
            .unresolvedPairs = choices.of(std::array{1u, ~0u}),
            .searches = choices.of(std::array{0u, ~0u})};
  }
  return {.queries = choices.of(std::array{0u, 2u, 3u, 4u, 8u}),
          .candidates = choices.of(std::array{0u, 1u, 3u, 16u, 100u, 1000u}),
          .rounds = choices.of(std::array{2u, 2u, 4u, 16u, 64u}),
          .unresolvedPairs = choices.of(std::array{0u, 1u, 2u, 20u, 200u}),
          .searches = choices.of(std::array{0u, 8u, 64u})};
}

bool isValid(const Capacity& capacity) {
  constexpr uint32_t kMost = 1u << 16;  // of what is chosen above
  return std::max({capacity.queries, capacity.candidates, capacity.unresolvedPairs, capacity.searches}) < kMost &&
         capacity.rounds >= 2 && capacity.rounds <= 64 && capacity.rounds % 2 == 0;
}

/// The queries that can be recorded, after those that cannot have been refused.
std::vector<Query> recordable(SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  std::vector<Query> queries = calls.queries(4);
  const auto isInvalid = [&](const Query& query) { return !validate(query, calls.scene()).empty(); };
  if (queries.size() > capacity.queries || std::ranges::any_of(queries, isInvalid)) {
    try {
      test::execute(test::device(), recorder, queries);
      require(false, "an invalid recording is accepted");
    } catch (const Error&) {
      std::erase_if(queries, isInvalid);
      queries.resize(std::min<size_t>(queries.size(), capacity.queries));
    }
  }
  return queries;
}

void ask(SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  const std::vector<Query> queries = recordable(calls, recorder, capacity);
  CpuSweeper cpu(calls.scene(), 1);
  std::vector<Result> exact = cpu.run(queries);
  const test::Answers expected{std::move(exact), cpu.lists()};
  test::Answers recorded;
  try {
    recorded = test::execute(test::device(), recorder, queries);
  } catch (const Error& error) {
    return require(std::string_view(error.what()).find("Capacity::searches") != std::string_view::npos, error.what());
  }
  checkRecorded(queries, recorded, expected);
  Capacity enough = enoughFor(recorder);
  for (int i = 0; i < 10 && isTooSmall(recorded); ++i) {
    Recorder larger(test::device(), calls.scene(), enough);
    recorded = test::execute(test::device(), larger, queries);
    checkRecorded(queries, recorded, expected);
    enough = enoughFor(larger);
  }
  require(!isTooSmall(recorded), "what needed() gives is not enough");
}

void run(std::string_view input) {
  Choices choices(input);
  const Capacity capacity = capacityFrom(choices);
  SceneCalls calls(choices);
  try {
    Recorder recorder(test::device(), calls.scene(), capacity);
    require(isValid(capacity), "an invalid capacity is accepted");
    for (int i = 0; i < 40 && !choices.areOver(); ++i) {
      if (choices.oneIn(4)) {
        ask(calls, recorder, capacity);
      } else {
        calls.edit();
      }
    }
  } catch (const Error& error) {
    require(!isValid(capacity) && std::string_view(error.what()).starts_with("Capacity::"), error.what());
  }
  for (const std::string& message : test::takeValidationMessages()) require(false, "validation: " + message);
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, [] { return randomSeeds(32, 400); }, {}};
  return kTarget;
}

}  // namespace radar::fuzz
