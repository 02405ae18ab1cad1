#include "fuzz/check_recorded.h"

#include <algorithm>
#include <cmath>

#include "fuzz/check_answers.h"
#include "fuzz/target.h"
#include "support/same_bits.h"

namespace radar::fuzz {

namespace {

constexpr uint32_t kTooSmall = Flag::candidates | Flag::rounds | Flag::unresolved;

/// But for the tier, and the order of contacts that are less than a rounding apart.
void requireAgreement(const Query& query, const Result& found, const Result& expected, Outcomes& outcomes) {
  if (found.object == expected.object || std::isnan(expected.t)) {
    return require(test::sameButTier(found, expected),
                   "another answer:" + inWords(query, found) + "; expected" + inWords(query, expected));
  }
  ++outcomes.reordered;
  require(found.status == expected.status && found.lo <= expected.hi && expected.lo <= found.hi,
          "another contact:" + inWords(query, found) + "; expected" + inWords(query, expected));
}

void checkAnswer(const Query& query, const Result& found, const Result& exact, Outcomes& outcomes) {
  if (found.flags == 0) {
    ++outcomes.answered;
    outcomes.hits += exact.status == Status::hit;
    if (query.clearance == 0 || exact.status != Status::overlap) return requireAgreement(query, found, exact, outcomes);
    return require(
        found.status == Status::overlap && found.object == kNone && found.t == 0 && found.lo == 0 && found.hi == 0,
        "no overlap:" + inWords(query, found));
  }
  outcomes.outOfRange += found.flags == Flag::range;
  outcomes.unresolved += found.flags == Flag::unresolved;
  outcomes.candidates += (found.flags & Flag::candidates) != 0;
  outcomes.rounds += (found.flags & Flag::rounds) != 0;
  require((found.flags & ~(kTooSmall | Flag::range)) == 0, "another flag: " + inWords(query, found));
  if (found.flags != Flag::unresolved) {
    require(found.object == kNone && !std::isfinite(found.t) && !std::isfinite(found.hi), "no answer, but a contact");
    return require(found.status == Status::invalid && std::isnan(found.lo), "a flag, but not invalid");
  }
  const double end = query.motion || query.turn ? 1 : query.distance;
  require(found.t == found.lo, "open, but t is not lo");
  if (found.status == Status::hit) {
    return require(exact.status == Status::hit && found.lo <= exact.hi && exact.lo <= found.hi,
                   "open, but not in its bracket");
  }
  require(found.status == Status::undecided && found.object == kNone && !std::isfinite(found.hi),
          "open, but a contact");
  require(found.lo <= (exact.status == Status::clear || query.anyHit ? end : exact.hi), "contact before lo");
}

}  // namespace

void checkRecorded(std::span<const Query> queries, const Answers& recorded, const Answers& expected,
                   Outcomes& outcomes) {
  require(recorded.results.size() == queries.size(), "another number of answers");
  for (size_t i = 0; i < queries.size(); ++i) {
    checkAnswer(queries[i], recorded.results[i], expected.results[i], outcomes);
    const std::vector<Result>&found = test::listedBy(recorded, i).hits, &listed = test::listedBy(expected, i).hits;
    const auto isOpen = [](const Result& result) { return result.flags != 0; };
    if (isOpen(recorded.results[i]) || std::ranges::any_of(found, isOpen)) continue;
    require(found.size() == listed.size(), "a list of another length");
    for (size_t k = 0; k < found.size() && queries[i].clearance == 0; ++k) {
      requireAgreement(queries[i], found[k], listed[k], outcomes);
    }
    outcomes.listed += found.size();
    require(test::listedBy(recorded, i).overlapping == test::listedBy(expected, i).overlapping, "another overlap");
  }
}

bool isTooSmall(const Answers& recorded) {
  return std::ranges::any_of(recorded.results, [](const Result& result) { return (result.flags & kTooSmall) != 0; });
}

Capacity enoughFor(const Recorder& recorder) {
  Capacity enough = recorder.needed();
  enough.candidates += enough.candidates / 4;
  enough.unresolvedPairs += enough.unresolvedPairs / 4;
  return enough;
}

}  // namespace radar::fuzz
