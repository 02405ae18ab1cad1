// How every tool times methods: all answer the same batches, in turns, so that what else the machine does meets all
// alike.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/clock.h"
#include "workloads/workload.h"

namespace radar::bench {

using tools::Batch;  // answered in one call

/// A way of answering queries.
struct Method {
  std::string name;
  std::function<std::vector<Result>(std::span<const Query>)> answer;
  std::function<void(uint32_t scene)> prepare = [](uint32_t) {};  ///< called before each batch, and timed apart
};

/// How often each method is run. One pass counts whatever the time is.
struct Repetition {
  uint32_t warmUps = 1;            ///< passes that do not count
  uint32_t least = 3, most = 15;   ///< passes that count
  double seconds = 1;              ///< once so much time has passed since the warm-up, `least` suffice
  Deadline deadline = Deadline();  ///< no further pass, and no warm-up, begins after it
};

/// Calls run(method, counts) for each method below `methods`, round by round.
void inTurns(const Repetition& repetition, size_t methods, const std::function<void(size_t, bool)>& run);

/// One pass over all batches.
struct Pass {
  Lap prepare, answer;
  std::vector<Result> answers;  ///< in the order of the batches
};
Pass play(const Method& method, std::span<const Batch> batches);

/// What was measured of one method.
struct Series {
  std::vector<Lap> prepare, answer;  ///< of each pass that counts
  std::vector<Result> answers;       ///< of the last pass
  uint64_t differ = 0;               ///< answers over all passes that are not those of the first method
};
std::vector<Series> measure(std::span<const Method> methods, std::span<const Batch> batches,
                            const Repetition& repetition);

/// Seconds on one clock, pass by pass.
std::vector<double> secondsOf(const std::vector<Lap>& laps, double Lap::*clock = &Lap::wall);

}  // namespace radar::bench
