#pragma once

#include <cstring>

#include "radar/radar.h"

namespace radar::test {

/// Whether two answers have the same bits: absent numbers are one NaN, and a Result has no padding.
inline bool sameBits(const Result& p, const Result& q) {
  return std::memcmp(&p, &q, sizeof(Result)) == 0;  // NOLINT(bugprone-suspicious-memory-comparison)
}

/// But for the tier.
inline bool sameAnswer(Result p, const Result& q) {
  p.tier = q.tier;
  return sameBits(p, q);
}

}  // namespace radar::test
