// The seeds of a test that generates its cases: a few of its own, or those that a person asks for.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace radar::test {

/// `few`; with RADAR_TEST_SEEDS="100 160" these 61 instead.
inline std::vector<uint32_t> seeds(std::vector<uint32_t> few) {
  const char* asked = std::getenv("RADAR_TEST_SEEDS");
  if (asked == nullptr) return few;
  size_t length = 0;
  const auto first = static_cast<uint32_t>(std::stoul(asked, &length));
  const auto last = static_cast<uint32_t>(std::stoul(asked + length));
  std::vector<uint32_t> all;
  for (uint32_t seed = first; seed <= last; ++seed) all.push_back(seed);
  return all;
}

}  // namespace radar::test
