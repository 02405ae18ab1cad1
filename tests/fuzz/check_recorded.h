// What a recording's answers must be, whatever its capacity.
#pragma once

#include "embed/execute.h"
#include "radar/recorder.h"
#include "support/answer.h"

namespace radar::fuzz {

/// How many answers of recordings are what.
struct Outcomes {
  size_t answered = 0, hits = 0, listed = 0;          ///< hits of answers; entries of their lists
  size_t reordered = 0;                               ///< contacts with another object, less than a rounding apart
  size_t candidates = 0, rounds = 0, unresolved = 0;  ///< no answers, by the limit that was too small
  size_t outOfRange = 0;                              ///< no answers, because of their numbers
  size_t lacking() const { return candidates + rounds + unresolved; }
  bool areExact() const { return lacking() + outOfRange + reordered == 0; }
};

/// Throws std::logic_error unless each answer is the expected one, or its flag says which limit was too small. Adds to
/// the outcomes.
void checkRecorded(std::span<const Query> queries, const Answers& recorded, const Answers& expected,
                   Outcomes& outcomes);
inline void checkRecorded(std::span<const Query> queries, const Answers& recorded, const Answers& expected) {
  Outcomes outcomes;
  checkRecorded(queries, recorded, expected, outcomes);
}

/// Whether a limit was too small for an answer.
bool isTooSmall(const Answers& recorded);
/// What the last recording needed, and some more: a list's length may differ when the same is recorded again.
Capacity enoughFor(const Recorder& recorder);

}  // namespace radar::fuzz
