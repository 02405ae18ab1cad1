#include "measure/timing.h"

#include <cmath>

#include "support/catch.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::tools;

namespace {

std::vector<std::pair<size_t, bool>> callsOf(const Repetition& repetition, size_t methods) {
  std::vector<std::pair<size_t, bool>> calls;
  inTurns(repetition, methods, [&](size_t method, bool counts) { calls.emplace_back(method, counts); });
  return calls;
}

}  // namespace

TEST_CASE("methods take turns, the warm-up does not count, and one pass counts whatever the time is") {
  using Calls = std::vector<std::pair<size_t, bool>>;
  const Calls once{{0, false}, {1, false}, {0, true}, {1, true}};
  CHECK(callsOf({.least = 1, .most = 1}, 2) == once);
  CHECK(callsOf({.least = 5, .deadline = Deadline(0)}, 2) == Calls{{0, true}, {1, true}});
  CHECK(callsOf({.warmUps = 0, .least = 3, .seconds = 0}, 1) == Calls{{0, true}, {0, true}, {0, true}});
  CHECK(callsOf({.warmUps = 0, .least = 1, .most = 4, .seconds = 1e9}, 1).size() == 4);
}

TEST_CASE("every method answers every batch in its scene, and answers that differ from the first's are counted") {
  const Workload workload = makeWorkload(Figure7{.teapots = 3, .boxes = 10, .steps = 2});
  const std::vector<Batch> batches = batchesOf(workload.queries);
  REQUIRE(batches.size() == 2);
  uint32_t shown = kNone;
  const auto method = [&](double t) {
    return Session{"",
                   [&, t](std::span<const Query> queries) {
                     std::vector<Result> results(queries.size());
                     for (Result& result : results) result.t = shown + t;
                     return results;
                   },
                   [&](uint32_t scene) { shown = scene; }};
  };
  const std::vector<Series> all =
      measure(std::vector{method(0), method(0), method(1)}, batches, {.least = 2, .most = 2});
  for (const Series& series : all) {
    CHECK(series.show.size() == 2);
    CHECK(series.answer.size() == 2);
    REQUIRE(series.answers.size() == 6);
    CHECK(series.answers[3].t - series.answers[2].t == 1);
  }
  CHECK(all[1].differ == 0);
  CHECK(all[2].differ == 3 * 6);
}

TEST_CASE("quantiles are values at or above their rank, and the median lies in the middle") {
  const std::vector<double> values{3, 1, 2, 4};
  CHECK(quantile(values, 0.25) == 1);
  CHECK(quantile(values, 0.5) == 2);
  CHECK(quantile(values, 0.99) == 4);
  CHECK(quantile(values, 1) == 4);
  CHECK(std::isnan(quantile({}, 0.5)));
  CHECK(median(values) == 2.5);
  CHECK(median({5, 1, 2}) == 2);
}
