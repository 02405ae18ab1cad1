// One query answered alone.
#pragma once

#include "radar/cpu_sweeper.h"

namespace radar::test {

inline Result answer(CpuSweeper& sweeper, const Query& query) {
  return sweeper.run({&query, 1})[0];
}

/// By a sweeper of its own.
inline Result answer(const Scene& scene, const Query& query) {
  CpuSweeper sweeper(scene, 1);
  return answer(sweeper, query);
}

}  // namespace radar::test
