#pragma once

#include <cstring>
#include <sstream>
#include <string>

#include "radar/radar.h"

namespace radar::test {

/// Whether two answers have the same bits: absent numbers are one NaN, and a Result has no padding.
inline bool sameBits(const Result& p, const Result& q) {
  return std::memcmp(&p, &q, sizeof(Result)) == 0;  // NOLINT(bugprone-suspicious-memory-comparison)
}

/// But for the tier, which says who has answered.
inline bool sameButTier(const Result& p, const Result& q) {
  Result ofSameTier = p;
  ofSameTier.tier = q.tier;
  return sameBits(ofSameTier, q);
}

/// Where answers first differ, in words; empty if they do not.
inline std::string differenceOf(std::span<const Result> found, std::span<const Result> expected,
                                bool (*same)(const Result&, const Result&) = sameBits) {
  std::ostringstream words;
  words.precision(17);
  const auto tell = [&](const Result& r) {
    words << " status " << static_cast<uint32_t>(r.status) << " tier " << static_cast<uint32_t>(r.tier) << " t " << r.t
          << " lo " << r.lo << " hi " << r.hi << " object " << r.object << " triangles " << r.triA << " and " << r.triB;
  };
  if (found.size() != expected.size()) words << found.size() << " answers, expected " << expected.size();
  for (size_t i = 0; found.size() == expected.size() && i < found.size(); ++i) {
    if (same(found[i], expected[i])) continue;
    words << "answer " << i << ":";
    tell(found[i]);
    words << ", expected";
    tell(expected[i]);
    break;
  }
  return words.str();
}

/// Likewise of the moments of a way that a query lists.
inline std::string momentDifference(const Listed& found, const Listed& expected,
                                    bool (*same)(const Result&, const Result&)) {
  const std::optional<Closest>&closest = found.closest, &right = expected.closest;
  if (closest.has_value() != right.has_value() || found.exit.has_value() != expected.exit.has_value()) {
    return "; only one has a closest approach or an exit";
  }
  std::string words;
  if (closest && (closest->lo != right->lo || closest->hi != right->hi)) words = "; another least distance";
  if (closest) words += differenceOf({&closest->at, 1}, {&right->at, 1}, same);
  if (found.exit) words += differenceOf({&*found.exit, 1}, {&*expected.exit, 1}, same);
  return words;
}

/// The same with their lists.
inline std::string differenceOf(const Answers& found, const Answers& expected,
                                bool (*same)(const Result&, const Result&) = sameBits) {
  std::string words = differenceOf(found.results, expected.results, same);
  if (found.lists.size() != expected.lists.size()) return words + "; lists of some queries only";
  for (size_t i = 0; words.empty() && i < found.lists.size(); ++i) {
    words = differenceOf(found.lists[i].hits, expected.lists[i].hits, same);
    if (found.lists[i].overlapping != expected.lists[i].overlapping) words += "; other objects overlap";
    words += momentDifference(found.lists[i], expected.lists[i], same);
    if (!words.empty()) words = "list of query " + std::to_string(i) + ": " + words;
  }
  return words;
}

}  // namespace radar::test
