#include "measure/try_out.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "child/in_child.h"
#include "measure/judge.h"
#include "radar/cpu_sweeper.h"

namespace radar::tools {

namespace {

// Of processor time, for a method that is apart: a hull of many triangles takes minutes.
constexpr unsigned kMostSeconds = 25;

// A slow method gets so much more time, then fewer passes than it should.
constexpr double kPatience = 6;

// An error that is infinite is known all the same.
double finite(double length) {
  return std::min(std::abs(length), std::numeric_limits<double>::max());
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The queries as a method is asked them.
std::vector<Batch> batchesFor(const Method& method, const Workload& workload) {
  std::vector<Batch> batches = batchesOf(workload.queries, method.size);
  for (Batch& batch : batches) {
    for (Query& query : batch.queries) {
      query.anyHit = false;
      if (!method.apart) continue;
      for (const auto& [object, bits] : workload.scenes[batch.scene].masks) {
        if ((bits & query.mask) == 0) query.exclude.push_back(object);
      }
    }
  }
  return batches;
}

struct Played {
  Times times;
  std::vector<Result> answers;
};

Played playAll(const Method& method, const Workload& workload, Repetition repetition) {
  Played played;
  Times& times = played.times;
  const std::vector<Batch> batches = batchesFor(method, workload);
  const Stopwatch stopwatch;
  const Session session = method.open(workload);
  session.show(0);
  times.prepareMs = 1e3 * stopwatch.lap().wall;
  repetition.deadline = Deadline(kPatience * repetition.seconds);
  Series series = std::move(measure({&session, 1}, batches, repetition).front());
  const std::vector<double> seconds = secondsOf(series.answer);
  const double perQuery = 1e6 / static_cast<double>(series.answers.size());
  times.passes = static_cast<uint32_t>(seconds.size());
  times.us = perQuery * quantile(seconds, 0.5);
  times.usLow = perQuery * quantile(seconds, 0.25);
  times.usHigh = perQuery * quantile(seconds, 0.75);
  times.cpuUs = perQuery * mean(secondsOf(series.answer, &Lap::process));
  times.sceneUs = perQuery * mean(secondsOf(series.show));
  played.answers = std::move(series.answers);
  return played;
}

// In a process of its own. Where it ends early, `failed` says how.
Played playApart(const Method& method, const Workload& workload, const Repetition& repetition, std::string& failed) {
  const auto work = [&] {
    const Played played = playAll(method, workload, repetition);
    std::string bytes(reinterpret_cast<const char*>(&played.times), sizeof(Times));
    return bytes.append(reinterpret_cast<const char*>(played.answers.data()), played.answers.size() * sizeof(Result));
  };
  const ChildOutcome outcome = inChild(work, {.seconds = kMostSeconds});
  failed = outcome.failed;
  Played played;
  if (!failed.empty()) return played;
  played.answers.resize((outcome.bytes.size() - sizeof(Times)) / sizeof(Result));
  std::memcpy(&played.times, outcome.bytes.data(), sizeof(Times));
  std::memcpy(played.answers.data(), &outcome.bytes[sizeof(Times)], played.answers.size() * sizeof(Result));
  return played;
}

}  // namespace

Truth truthOf(const Workload& workload) {
  Truth truth;
  ScenePlayer player(workload);
  CpuSweeper cpu(player.scene());
  for (const Batch& batch : batchesFor({}, workload)) {
    player.show(batch.scene);
    const std::vector<Result> answers = cpu.run(batch.queries).results;
    truth.answers.insert(truth.answers.end(), answers.begin(), answers.end());
    for (const Query& query : batch.queries) {
      const double size = sensorSize(player.scene(), query);
      truth.sizes.push_back(size > 0 ? size : 1);
    }
  }
  return truth;
}

Accuracy accuracyOf(std::span<const Result> answers, const Truth& truth, bool certified) {
  Accuracy accuracy{.certified = certified};
  std::vector<double> errors, widths;
  for (size_t i = 0; i < answers.size(); ++i) {
    const Verdict verdict = judge(answers[i], truth.answers[i], truth.sizes[i]);
    const bool isBounded = !std::isnan(answers[i].hi);
    accuracy.contacts += meets(truth.answers[i]);
    accuracy.found += verdict.found;
    accuracy.misses += verdict[Fault::missed] || verdict.unseen;
    accuracy.falseHits += verdict[Fault::falseHit];
    accuracy.violations +=
        verdict[Fault::bracket] || (verdict[Fault::falseHit] && isBounded) || (verdict[Fault::missed] && certified);
    if (!verdict.found) continue;
    errors.push_back(finite(verdict.error));
    if (certified) widths.push_back(finite((answers[i].hi - answers[i].lo) / truth.sizes[i]));
  }
  accuracy.errorMedian = quantile(errors, 0.5);
  accuracy.error99 = quantile(errors, 0.99);
  accuracy.errorWorst = quantile(errors, 1);
  accuracy.widthWorst = quantile(widths, 1);
  return accuracy;
}

Cell tryOut(const Case& which, const Workload& workload, const Method& method, const Truth& truth,
            const Repetition& repetition) {
  Cell cell;
  cell.section = which.section;
  cell.workload = which.workload;
  cell.x = which.x;
  cell.method = method.name();
  cell.family = method.family;
  cell.size = method.size;
  cell.threads = method.threads;
  cell.queries = static_cast<uint32_t>(workload.queries.size());
  const Played played =
      method.apart ? playApart(method, workload, repetition, cell.failed) : playAll(method, workload, repetition);
  if (!cell.failed.empty()) return cell;
  static_cast<Times&>(cell) = played.times;
  static_cast<Accuracy&>(cell) = accuracyOf(played.answers, truth, method.certified);
  return cell;
}

}  // namespace radar::tools
