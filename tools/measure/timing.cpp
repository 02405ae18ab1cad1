#include "measure/timing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "workloads/same_answer.h"

namespace radar::tools {

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<size_t>(rank, 1) - 1];
}

std::vector<Result> resultsOf(Answers answers) {
  if (!answers.stats.lost.empty()) throw Error("the device is lost: " + answers.stats.lost);
  return std::move(answers.results);
}

void inTurns(const Repetition& repetition, size_t sessions, const std::function<void(size_t, bool)>& run) {
  const auto round = [&](bool counts) {
    for (size_t session = 0; session < sessions; ++session) run(session, counts);
  };
  for (uint32_t i = 0; i < repetition.warmUps && !repetition.deadline.isOver(); ++i) round(false);
  const Stopwatch stopwatch;
  for (uint32_t counted = 0; counted < repetition.most; ++counted) {
    const bool isEnough = counted >= repetition.least && stopwatch.lap().wall >= repetition.seconds;
    if (counted > 0 && (isEnough || repetition.deadline.isOver())) return;
    round(true);
  }
}

Pass play(const Session& session, std::span<const Batch> batches) {
  Pass pass;
  for (const Batch& batch : batches) {
    pass.show += lapOf([&] { session.show(batch.scene); });
    std::vector<Result> results;
    pass.answer += lapOf([&] { results = session.answer(batch.queries); });
    pass.answers.insert(pass.answers.end(), std::make_move_iterator(results.begin()),
                        std::make_move_iterator(results.end()));
  }
  return pass;
}

std::vector<Series> measure(std::span<const Session> sessions, std::span<const Batch> batches,
                            const Repetition& repetition) {
  std::vector<Series> all(sessions.size());
  inTurns(repetition, sessions.size(), [&](size_t s, bool counts) {
    Series& series = all[s];
    Pass pass = play(sessions[s], batches);
    series.answers = std::move(pass.answers);
    for (size_t i = 0; i < series.answers.size(); ++i) {
      series.differ += sameAnswer(series.answers[i], all[0].answers[i]) ? 0 : 1;
    }
    if (!counts) return;
    series.show.push_back(pass.show);
    series.answer.push_back(pass.answer);
  });
  return all;
}

std::vector<double> secondsOf(const std::vector<Lap>& laps, double Lap::*clock) {
  std::vector<double> seconds(laps.size());
  std::transform(laps.begin(), laps.end(), seconds.begin(), [&](const Lap& lap) { return lap.*clock; });
  return seconds;
}

}  // namespace radar::tools
