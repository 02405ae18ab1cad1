#include "soak/batch.h"

#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "fuzz/check_answers.h"
#include "fuzz/target.h"
#include "support/same_bits.h"

namespace radar::soak {

using fuzz::require;

void measured(Who who, Tally& tally, const std::function<void()>& part) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  try {
    part();
  } catch (const std::exception& error) {
    throw std::logic_error(std::string(kWho[static_cast<size_t>(who)]) + ": " + error.what());
  }
  tally.addSeconds(who, std::chrono::duration<double>(Clock::now() - start).count());
}

void checkBatch(const Batch& batch, const Answers& found, const std::string& allowed, Who who, Tally& tally) {
  require(found.results.size() == batch.queries.size(), "another number of answers");
  for (size_t i = 0; i < batch.queries.size(); ++i) {
    const Query& query = batch.queries[i];
    const Result &result = found.results[i], &exact = batch.exact.results[i];
    const auto fail = [&](const std::string& what) {
      if (!allowed.empty()) std::printf("after %s\n", allowed.c_str());
      require(false, "query " + std::to_string(i) + ": " + what + ": found" + fuzz::inWords(query, result) +
                         "; expected" + fuzz::inWords(query, exact));
    };
    if (batch.mode == Mode::sampled) {
      fuzz::checkSampled(result, exact, test::reasonFor(found, i));
      tally.add(Who::sampled, 1);
      continue;
    }
    tally.add(who, 1);
    if (result.status == Status::invalid && !allowed.empty()) {
      const std::string reason = test::reasonFor(found, i);
      if (reason.find(allowed) == std::string::npos) fail("invalid for another reason: " + reason);
      ++tally.invalid;
      continue;
    }
    if (!test::sameButTier(result, exact)) fail("another answer");
    const Listed &ours = test::listedBy(found, i), &theirs = test::listedBy(batch.exact, i);
    const std::string difference = test::differenceOf(ours.hits, theirs.hits, test::sameButTier);
    if (!difference.empty()) fail("another list of hits: " + difference);
    if (ours.overlapping != theirs.overlapping) fail("another overlap");
  }
}

void checkBrackets(const Batch& batch, std::span<const Result> found, Tally& tally) {
  const auto meets = [](const Result& result) {
    return result.status == Status::hit || result.status == Status::overlap;
  };
  for (size_t i = 0; i < batch.queries.size(); ++i) {
    const Result &p = found[i], &q = batch.exact.results[i];
    const bool isOpen = p.status == Status::undecided || q.status == Status::undecided;
    require((isOpen || meets(p) == meets(q)) && p.lo <= q.hi && q.lo <= p.hi,
            "two answers that exclude each other:" + fuzz::inWords(batch.queries[i], p) + " and" +
                fuzz::inWords(batch.queries[i], q));
    tally.add(Who::cpu, 1);
  }
}

}  // namespace radar::soak
