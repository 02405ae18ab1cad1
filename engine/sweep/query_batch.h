// The current batch: what tiers read and write.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>

#include "radar/radar.h"

namespace radar {

using Clock = std::chrono::steady_clock;

inline double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct QueryBatch {
  std::span<const Query> asked;
  std::span<Result> answers;  ///< one for each query
  SweepStats stats;
  std::map<size_t, std::string> reasons;  ///< why an answer is invalid, by its index
  std::optional<Error> failure;           ///< the first Vulkan call that failed
  Clock::time_point deviceDone;
  bool timestamps = false;

  /// Records that a failed Vulkan call left the query without an answer; rethrows any other error.
  void fail(size_t query, const Error& error);
  void addCpuTime(const char* name, double ms);
};

}  // namespace radar
