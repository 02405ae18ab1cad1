// Random scenes and queries that have some of the options: small shapes on a lattice, so that they touch, overlap, are
// flush or pass at just the clearance.
#pragma once

#include <string>

#include "unit/soups.h"

namespace radar::test {

enum Option : uint32_t {
  kExclude = 1,
  kMask = 2,
  kSkipOverlapping = 4,
  kIgnoreLeaving = 8,
  kSlack = 16,
  kClearance = 32,
  kTolerance = 64,
  kMotion = 128,
  kHits = 256,
  kDecide = 512
};
/// In that order, as query files name them.
inline constexpr std::array kOptionNames{"exclude",   "mask",      "skip_overlapping", "ignore_leaving", "slack",
                                         "clearance", "tolerance", "motion",           "hits",           "any_hit"};

/// Replaces the scene by a random one, and returns queries through it, all with those options: valid, except that
/// `hits` and `any_hit` together are refused.
std::vector<Query> drawn(soups::Random& random, uint32_t options, Scene& scene);

}  // namespace radar::test
