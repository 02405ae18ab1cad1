// Fuzzes a Recorder: an input is a capacity and a sequence of edits of a scene and of recordings. Each answer is the
// CPU's, or its flag says which limit was too small; with the capacity that needed() gives, all are answered.
#include <cmath>

#include "embed/on_device.h"
#include "fuzz/check_answers.h"
#include "fuzz/scene_calls.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"

namespace radar::fuzz {

namespace {

constexpr uint32_t kTooSmall = kFlagCandidates | kFlagRounds | kFlagUnresolved;

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

struct Recorded {
  std::vector<Result> answers;
  Lists lists;
};

Recorded execute(Recorder& recorder, std::span<const Query> queries) {
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), queries);
  submission.submitAndWait();
  Recorded recorded;
  recorded.answers = recorder.read(&recorded.lists);
  return recorded;
}

/// But for the tier, and the order of contacts that are less than a rounding apart.
void requireAgreement(Result found, const Result& expected) {
  found.tier = expected.tier;
  if (found.object == expected.object || std::isnan(expected.t)) {
    return require(test::sameBits(found, expected), "another answer");
  }
  require(found.status == expected.status && found.lo <= expected.hi && expected.lo <= found.hi, "another contact");
}

void checkAnswer(const Query& query, const Result& found, const Result& exact) {
  if (found.flags == 0 && query.clearance > 0 && exact.status == Status::overlap) {
    return require(found.status == Status::overlap && found.t == 0, "no overlap");
  }
  if (found.flags == 0) return requireAgreement(found, exact);
  require((found.flags & ~(kTooSmall | kFlagRange)) == 0, "another flag");
  require(found.object == kNone && !std::isfinite(found.t) && !std::isfinite(found.hi), "no answer, but a contact");
  if (found.flags != kFlagUnresolved) return require(found.status == Status::invalid, "a flag, but not invalid");
  const double end = query.motion ? 1 : query.distance;
  require(found.status == Status::undecided, "open, but not undecided");
  require(found.lo <= (exact.status == Status::clear || query.anyHit ? end : exact.hi), "contact before lo");
}

void check(std::span<const Query> queries, const Recorded& recorded, std::span<const Result> exact,
           const Lists& exactLists) {
  require(recorded.answers.size() == queries.size(), "another number of answers");
  for (size_t i = 0; i < queries.size(); ++i) {
    checkAnswer(queries[i], recorded.answers[i], exact[i]);
    const auto found = recorded.lists.hitsOf(i), expected = exactLists.hitsOf(i);
    const auto isOpen = [](const Result& result) { return result.flags != 0; };
    if (isOpen(recorded.answers[i]) || std::ranges::any_of(found, isOpen)) continue;
    require(found.size() == expected.size(), "a list of another length");
    for (size_t k = 0; k < found.size() && queries[i].clearance == 0; ++k) requireAgreement(found[k], expected[k]);
    require(std::ranges::equal(recorded.lists.overlappingOf(i), exactLists.overlappingOf(i)), "another overlap");
  }
}

bool isTooSmall(const Recorded& recorded) {
  return std::ranges::any_of(recorded.answers, [](const Result& result) { return (result.flags & kTooSmall) != 0; });
}

/// The queries that can be recorded, after those that cannot have been refused.
std::vector<Query> recordable(SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  std::vector<Query> queries = calls.queries(4);
  const auto isInvalid = [&](const Query& query) { return !validate(query, calls.scene()).empty(); };
  if (queries.size() > capacity.queries || std::ranges::any_of(queries, isInvalid)) {
    try {
      execute(recorder, queries);
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
  const std::vector<Result> exact = cpu.run(queries);
  Recorded recorded;
  try {
    recorded = execute(recorder, queries);
  } catch (const Error& error) {
    return require(std::string_view(error.what()).find("Capacity::searches") != std::string_view::npos, error.what());
  }
  check(queries, recorded, exact, cpu.lists());
  Capacity enough = recorder.needed();
  for (int i = 0; i < 10 && isTooSmall(recorded); ++i) {
    // A list's length may differ when the same is recorded again.
    enough.candidates += enough.candidates / 4;
    enough.unresolvedPairs += enough.unresolvedPairs / 4;
    Recorder larger(test::device(), calls.scene(), enough);
    recorded = execute(larger, queries);
    check(queries, recorded, exact, cpu.lists());
    enough = larger.needed();
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

std::vector<std::string> seeds() {
  return randomSeeds(32, 400);
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, {}};
  return kTarget;
}

}  // namespace radar::fuzz
