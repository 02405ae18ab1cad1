// The current batch: what tiers read and write.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "radar/radar.h"
#include "scene/scene.h"

namespace radar {

using Clock = std::chrono::steady_clock;

inline double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct QueryBatch {
  std::span<const Query> asked;
  Answers answers;
  std::optional<Error> failure;  ///< the first Vulkan call that failed, also if all queries were answered
  Clock::time_point deviceDone;
  bool timestamps = false;

  /// Records that a failed Vulkan call left the query without an answer; rethrows any other error.
  void fail(size_t query, const Error& error);
  /// If a call failed for lack of memory, records that, and returns true: its queries can be answered otherwise.
  bool survives(const Error& error);
  void addCpuTime(const char* name, double ms);
};

/// The queries of one submission, between its start and its collection. If a Vulkan call fails, these queries fail and
/// the batch goes on.
class PendingQueries {
 public:
  explicit PendingQueries(QueryBatch& batch) : batch_(batch) {}

  /// Calls `start` with the queries; they are pending if it returns true. None may be pending before.
  template <class Start>
  void submit(std::vector<size_t> queries, const Start& start) {
    guarded(queries, [&] {
      if (start(queries)) queries_.swap(queries);
    });
  }

  /// Calls `decode` with the pending queries, if there are any; none are pending afterwards.
  template <class Decode>
  void collect(const Decode& decode) {
    const std::vector<size_t> queries = std::exchange(queries_, {});
    if (!queries.empty()) guarded(queries, [&] { decode(queries); });
  }

 private:
  template <class Work>
  void guarded(const std::vector<size_t>& queries, const Work& work) {
    try {
      work();
    } catch (const Error& error) {
      for (const size_t query : queries) batch_.fail(query, error);
    }
  }

  QueryBatch& batch_;
  std::vector<size_t> queries_;
};

}  // namespace radar
