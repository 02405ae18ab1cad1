// One batch on its way: its answers so far, and what is still open.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "contact/search_plan.h"
#include "radar/answers.h"
#include "sweep/batch_router.h"

namespace radar {

using Clock = std::chrono::steady_clock;

inline double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Flight {
  /// `asked` stays in place until the batch is answered. `timestamps`: as SweeperOptions::timestamps. `wanted`: until
  /// this is requested to stop. `memory`: to be used again.
  Flight(std::span<const Query> asked, bool timestamps, std::stop_token wanted = {}, Answers memory = {});
  /// The same of mode contact, with what is known of the queries.
  Flight(std::span<const Query> asked, std::span<const SearchNeeds> known, bool timestamps, std::stop_token wanted,
         Answers memory);

  std::span<const Query> queries;
  Answers answers;
  std::optional<Error> failure;  ///< the first Vulkan call that failed, also if all queries were answered
  Clock::time_point deviceDone;  ///< when the device ended the last submission
  bool measures;                 ///< SweeperOptions::timestamps
  std::stop_token stop;          ///< once requested, runners throw Cancelled

  // Mode contact.
  std::span<const SearchNeeds> needs;         ///< of the queries; none until they are looked at
  std::span<char> open;                       ///< 1 where a query's result may be an earlier batch's
  uint32_t cpuBatch = 0;                      ///< fewer queries at once than this are for the CPU
  std::optional<BatchRouter::Choice> choice;  ///< that a router made
  Clock::time_point begun;                    ///< when it did
  bool isAlone = true;                        ///< no other batch of its device was on its way meanwhile
  std::vector<size_t> left;                   ///< queries for the CPU
  std::vector<size_t> again;                  ///< queries to repeat, now that the device has room for them
  Clock::time_point encoding;                 ///< since when the next submission is being planned
  // Mode sampled.
  std::vector<size_t> drawn;  ///< queries of the last submission, until it is collected

  /// Records that a failed Vulkan call, or what the device computed, left the query without an answer; rethrows any
  /// other error.
  void fail(size_t query, const Error& error);
  /// If a call failed for lack of memory, or because the device is lost, records that, and returns true: its queries
  /// can be answered otherwise.
  bool survives(const Error& error);
  void addCpuTime(const char* name, double ms);
};

}  // namespace radar
