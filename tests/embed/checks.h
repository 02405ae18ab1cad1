// What tests of recordings check again and again.
#pragma once

#include <cmath>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"

namespace radar::test {

/// Answers have the same bits.
inline void checkSame(std::span<const Result> found, std::span<const Result> expected) {
  REQUIRE(found.size() == expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, found[i].flags, found[i].t, expected[i].t, found[i].object, expected[i].object);
    CHECK(sameBits(found[i], expected[i]));
  }
}

/// The CPU's answers, as of the tier that a Recorder names.
inline std::vector<Result> expectedOf(const Scene& scene, std::span<const Query> queries) {
  std::vector<Result> expected = CpuSweeper(scene, 1).run(queries).results;
  for (Result& result : expected) result.tier = Tier::contact;
  return expected;
}

/// Whether no answer is given, for this reason.
inline bool isRefused(const Result& result, uint32_t flag) {
  return result.status == Status::invalid && result.flags == flag && std::isnan(result.lo);
}

/// Synchronization validation, where it watches, reports a read that does not wait for a write, if that is expected, or
/// else nothing.
inline void checkHazard(bool isExpected) {
  const std::vector<std::string> messages = takeValidationMessages();
  CHECK(messages.empty() != (isExpected && isValidated()));
  if (!messages.empty()) CHECK_THAT(messages[0], Contains("SYNC-HAZARD-READ-AFTER-WRITE"));
}

}  // namespace radar::test
