// Answers a single query on the CPU.
#pragma once

#include "radar/cpu_sweeper.h"

namespace radar::test {

inline Result answer(CpuSweeper& sweeper, const Query& query) {
  return sweeper.run({&query, 1})[0];
}

/// With a new sweeper.
inline Result answer(const Scene& scene, const Query& query) {
  CpuSweeper sweeper(scene, 1);
  return answer(sweeper, query);
}

}  // namespace radar::test
