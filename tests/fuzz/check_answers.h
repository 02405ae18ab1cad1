// What answers must be, whatever is asked.
#pragma once

#include "radar/answers.h"
#include "radar/query.h"

namespace radar::fuzz {

/// Throws std::logic_error if exact answers to valid queries, or their lists, break their contract or differ from brute
/// force in exact integers. Queries too costly for brute force, or whose placed coordinates are not finite, are held
/// only to their contract.
void checkAnswers(const Scene& scene, std::span<const Query> queries, const Answers& answers);

/// Throws std::logic_error if an answer of mode sampled says anything wrong; it may be late or open.
void checkSampled(const Result& sampled, const Result& exact, const std::string& reason);

/// A query and its answer, for the message of a failure.
std::string inWords(const Query& query, const Result& result);

/// Throws std::logic_error unless two batches of answers and their lists have the same bits, but for the tier.
void requireSame(const Answers& found, const Answers& expected);

}  // namespace radar::fuzz
