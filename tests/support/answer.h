// Answers for tests: to a batch, of the CPU to a single query, and made-up ones.
#pragma once

#include <utility>

#include "radar/cpu_sweeper.h"

namespace radar::test {

/// The answers to a batch.
struct Answers {
  std::vector<Result> results;
  Lists lists;
};

template <class Sweeper>
Answers ask(Sweeper& sweeper, std::span<const Query> queries) {
  std::vector<Result> results = sweeper.run(queries);
  return {std::move(results), sweeper.lists()};
}

inline Result answer(CpuSweeper& sweeper, const Query& query) {
  return sweeper.run({&query, 1})[0];
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
