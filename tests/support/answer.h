// Answers for tests: parts of those to a batch, of the CPU to a single query, and made-up ones.
#pragma once

#include <string>

#include "radar/cpu_sweeper.h"

namespace radar::test {

/// What a query lists.
inline const Listed& listedBy(const Answers& answers, size_t query) {
  static const Listed kNothing;
  return answers.lists.empty() ? kNothing : answers.lists[query];
}

/// Why a query is not answered; empty if it is.
inline std::string reasonFor(const Answers& answers, size_t query) {
  const auto found = answers.reasons.find(query);
  return found == answers.reasons.end() ? "" : found->second;
}

inline Result answer(CpuSweeper& sweeper, const Query& query) {
  return sweeper.run({&query, 1}).results[0];
}

/// With a new sweeper.
inline Result answer(const Scene& scene, const Query& query) {
  CpuSweeper sweeper(scene, 1);
  return answer(sweeper, query);
}

/// An answer that is made up.
inline Result madeUpAnswer(Status status, double t, double lo, double hi) {
  Result result;
  result.status = status;
  result.t = t;
  result.lo = lo;
  result.hi = hi;
  return result;
}

}  // namespace radar::test
