// What a recording's answers must be, whatever its capacity.
#pragma once

#include "embed/execute.h"
#include "radar/recorder.h"
#include "support/answer.h"

namespace radar::fuzz {

/// Throws std::logic_error unless each answer is the expected one, or its flag says which limit was too small.
void checkRecorded(std::span<const Query> queries, const Answers& recorded, const Answers& expected);

/// Whether a limit was too small for an answer.
bool isTooSmall(const Answers& recorded);
/// What the last recording needed, and some more: a list's length may differ when the same is recorded again.
Capacity enoughFor(const Recorder& recorder);

}  // namespace radar::fuzz
