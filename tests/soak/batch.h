// A batch of queries, its exact answers, and whether others are right.
#pragma once

#include <functional>
#include <string>

#include "soak/tally.h"
#include "support/answer.h"

namespace radar::soak {

struct Batch {
  std::vector<Query> queries;
  Mode mode = Mode::contact;
  Answers exact{};
};

/// Throws std::logic_error unless each answer has the bits of the exact one, or, in mode sampled, says nothing wrong.
/// `allowed`: if not empty, answers may be invalid for a reason that has this in it; they are counted.
void checkBatch(const Batch& batch, const Answers& found, const std::string& allowed, Who who, Tally& tally);

/// Throws std::logic_error if an answer contradicts the CPU's other one to the same query with a clearance.
void checkBrackets(const Batch& batch, std::span<const Result> found, Tally& tally);

/// Lets `who` answer: adds its name to the message of a failure, and its time to the tally.
void measured(Who who, Tally& tally, const std::function<void()>& part);

}  // namespace radar::soak
