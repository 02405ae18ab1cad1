#include "bench/harness.h"

#include <algorithm>
#include <iterator>

#include "workloads/same_answer.h"

namespace radar::bench {

void inTurns(const Repetition& repetition, size_t methods, const std::function<void(size_t, bool)>& run) {
  const auto round = [&](bool counts) {
    for (size_t method = 0; method < methods; ++method) run(method, counts);
  };
  for (uint32_t i = 0; i < repetition.warmUps && !repetition.deadline.isOver(); ++i) round(false);
  const double begun = now();
  for (uint32_t counted = 0; counted < repetition.most; ++counted) {
    const bool isEnough = counted >= repetition.least && now() - begun >= repetition.seconds;
    if (counted > 0 && (isEnough || repetition.deadline.isOver())) return;
    round(true);
  }
}

Pass play(const Method& method, std::span<const Batch> batches) {
  Pass pass;
  for (const Batch& batch : batches) {
    pass.prepare += lapOf([&] { method.prepare(batch.scene); });
    std::vector<Result> results;
    pass.answer += lapOf([&] { results = method.answer(batch.queries); });
    pass.answers.insert(pass.answers.end(), std::make_move_iterator(results.begin()),
                        std::make_move_iterator(results.end()));
  }
  return pass;
}

std::vector<Series> measure(std::span<const Method> methods, std::span<const Batch> batches,
                            const Repetition& repetition) {
  std::vector<Series> all(methods.size());
  inTurns(repetition, methods.size(), [&](size_t m, bool counts) {
    Series& series = all[m];
    Pass pass = play(methods[m], batches);
    series.answers = std::move(pass.answers);
    for (size_t i = 0; i < series.answers.size(); ++i) {
      series.differ += tools::sameAnswer(series.answers[i], all[0].answers[i]) ? 0 : 1;
    }
    if (!counts) return;
    series.prepare.push_back(pass.prepare);
    series.answer.push_back(pass.answer);
  });
  return all;
}

std::vector<double> secondsOf(const std::vector<Lap>& laps, double Lap::*clock) {
  std::vector<double> seconds(laps.size());
  std::transform(laps.begin(), laps.end(), seconds.begin(), [&](const Lap& lap) { return lap.*clock; });
  return seconds;
}

}  // namespace radar::bench
