#include <algorithm>

#include "proof/checks.h"
#include "proof/known_scene.h"
#include "radar/cpu_sweeper.h"
#include "sweep/sweeper.h"

namespace radar {

AnswerCheck orAllWrong(const char* kind, size_t asked, const std::function<AnswerCheck()>& check) {
  try {
    return check();
  } catch (const Error& error) {
    if (error.kind != Error::Kind::internal) throw;
    const auto all = static_cast<uint32_t>(asked);
    return {
        .kind = kind, .asked = all, .wrong = all, .stage = nameOf(Stage::searching, false), .firstWrong = error.what()};
  }
}

AnswerCheck compared(const char* kind, std::vector<Result> found, std::span<const Result> exact, bool places) {
  found.resize(exact.size());
  AnswerCheck check{.kind = kind, .asked = static_cast<uint32_t>(exact.size())};
  Stage first = Stage::none;
  for (size_t i = 0; i < exact.size(); ++i) {
    const auto [stage, numbers] = differenceOf(found[i], exact[i]);
    if (stage == Stage::none) continue;
    if (check.wrong == 0) check.firstWrong = "answer " + std::to_string(i) + ": " + numbers;
    ++check.wrong;
    first = std::max(first, stage);
  }
  check.stage = nameOf(first, places);
  return check;
}

namespace {

// The answers, then what they list.
std::vector<Result> all(Answers answers) {
  for (const Listed& listed : answers.lists) {
    answers.results.insert(answers.results.end(), listed.hits.begin(), listed.hits.end());
  }
  return std::move(answers.results);
}

Answers answersOf(const Device::Impl& device, const Scene& scene, std::span<const Query> queries, Mode mode) {
  Sweeper::Impl sweeper(device, scene, {.cpuBatch = 0}, std::make_shared<GpuScene>(device), {}, false);
  Flight flight(queries, false);
  sweeper.begin(flight, mode);
  sweeper.finish(flight);
  if (flight.failure) throw Error(*flight.failure);
  return std::move(flight.answers);
}

AnswerCheck check(const char* kind, const Device::Impl& device, const KnownScene& known,
                  std::span<const Query> queries) {
  return orAllWrong(kind, queries.size(), [&] {
    Answers found = answersOf(device, known.scene, queries, Mode::contact);
    const uint64_t onCpu = found.stats.cpuQueries;
    AnswerCheck check = compared(kind, all(std::move(found)), all(CpuSweeper(known.scene).run(queries)));
    // But for clearances, where the device may well leave queries open.
    if (onCpu > 0 && queries[0].clearance == 0) {
      check.wrong += static_cast<uint32_t>(onCpu);
      if (check.stage.empty()) check.stage = nameOf(Stage::solving, false);
      check.firstWrong +=
          (check.firstWrong.empty() ? "" : "; ") + std::to_string(onCpu) + " queries were left to the CPU";
    }
    return check;
  });
}

}  // namespace

std::vector<AnswerCheck> checkSweeper(const Device::Impl& device, uint64_t seed) {
  KnownScene known(seed);
  std::vector<AnswerCheck> checks{check("first contacts", device, known, known.queries)};
  std::vector<Query> queries = known.queries;
  for (Query& query : queries) {
    if (!query.anyHit) query.hits = query.mask == 1 ? kAllHits : 3;
  }
  checks.push_back(check("lists", device, known, queries));
  queries = known.queries;
  for (Query& query : queries) query.motion = std::exchange(query.direction, {}), query.distance = 0;
  for (ObjectId id = 0; id < 32; id += 3) known.scene.setMotion(id, {0.5, -1, 0.25});
  checks.push_back(check("steps", device, known, queries));
  return checks;
}

AnswerCheck checkClearances(const Device::Impl& device, uint64_t seed) {
  const KnownScene known(seed);
  std::vector<Query> queries = known.queries;
  std::erase_if(queries, [](const Query& query) { return query.ignoreLeaving; });
  for (Query& query : queries) query.clearance = 0.125;
  return check("clearances", device, known, queries);
}

AnswerCheck checkSampled(const Device::Impl& device, uint64_t seed) {
  const KnownScene known(seed);
  std::vector<Query> queries = known.queries;
  for (Query& query : queries) {
    query.anyHit = query.ignoreLeaving = false;
    query.slack.reset();
  }
  const std::vector<Result> exact = CpuSweeper(known.scene).run(queries).results;
  std::vector<Result> found = answersOf(device, known.scene, queries, Mode::sampled).results;
  // Right answers are replaced by the exact ones, with which they are then compared.
  for (size_t i = 0; i < queries.size(); ++i) {
    const bool holds = found[i].flags == 0 && found[i].status != Status::invalid && found[i].lo <= exact[i].hi &&
                       exact[i].lo <= found[i].hi;
    if (holds && (found[i].status == Status::undecided ||
                  (found[i].status == Status::clear) == (exact[i].status == Status::clear))) {
      found[i] = exact[i];
    }
  }
  AnswerCheck check = compared("mode sampled", found, exact);
  if (!check.passed()) check.stage = "drawing or solving";
  return check;
}

}  // namespace radar
