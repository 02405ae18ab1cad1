// How every tool times ways of answering: all answer the same batches, in turns, so that what else the machine does
// meets all alike.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/clock.h"
#include "workloads/workload.h"

namespace radar::tools {

/// The middle of the values; of an even number, the mean of the two in the middle; NaN of none.
double median(std::vector<double> values);
/// The value below which `share` of the values lie: the least at or above that rank. NaN of none.
double quantile(std::vector<double> values, double share);

/// What answers queries, each batch in one call.
struct Session {
  std::string name;
  std::function<std::vector<Result>(std::span<const Query>)> answer;
  std::function<void(uint32_t scene)> show = [](uint32_t) {};  ///< called before each batch, and timed apart
};

/// The results of `answers`. Throws Error if the device is lost, and they are the CPU's.
std::vector<Result> resultsOf(Answers answers);

/// How often each session answers. One pass counts whatever the time is.
struct Repetition {
  uint32_t warmUps = 1;            ///< passes that do not count
  uint32_t least = 3, most = 15;   ///< passes that count
  double seconds = 1;              ///< once so much time has passed since the warm-up, `least` suffice
  Deadline deadline = Deadline();  ///< no further pass, and no warm-up, begins after it
};

/// Calls run(session, counts) for each session below `sessions`, round by round.
void inTurns(const Repetition& repetition, size_t sessions, const std::function<void(size_t, bool)>& run);

/// One pass over all batches.
struct Pass {
  Lap show, answer;
  std::vector<Result> answers;  ///< in the order of the batches
};
Pass play(const Session& session, std::span<const Batch> batches);

/// What was measured of one session.
struct Series {
  std::vector<Lap> show, answer;  ///< of each pass that counts
  std::vector<Result> answers;    ///< of the last pass
  uint64_t differ = 0;            ///< answers over all passes that are not those of the first session
};
std::vector<Series> measure(std::span<const Session> sessions, std::span<const Batch> batches,
                            const Repetition& repetition);

/// Seconds on one clock, pass by pass.
std::vector<double> secondsOf(const std::vector<Lap>& laps, double Lap::*clock = &Lap::wall);

}  // namespace radar::tools
