// Without a reference: what leaves the first contact where it is must leave every answer within its bracket.
#include <algorithm>
#include <array>
#include <cmath>

#include "measure/case_run.h"
#include "stability/same_contact.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/test_device.h"

using namespace radar;
using namespace radar::tools;

namespace {

struct Change {
  const char* name;
  HardCase (*apply)(const HardCase& hard, Random& random);  // null: D is split in two
};
constexpr Change kChanges[] = {
    {"everything moved together", movedTogether},
    {"sensor and object swapped", [](const HardCase& hard, Random&) { return changedPlaces(hard); }},
    {"triangles cut in two", cutInTwo},
    {"far objects added", withFarObjects},
    {"D split in two", nullptr}};

constexpr Approach kAsked[] = {{64}, {}};  // of modes sampled and contact

/// The answer to a way from the answers to its two parts, `first` long the first.
Result joined(const Result& one, const Result& two, double first) {
  if (meets(one)) return one;
  Result result = two;
  const bool clear = two.status == Status::clear;
  if (one.status == Status::clear) {
    if (clear) return result;
    // The sums round.
    result.lo = std::nextafter(first + two.lo, 0);
    result.hi = std::nextafter(first + two.hi, INFINITY);
    return result;
  }
  result.lo = one.lo;
  if (clear) {  // the second part knows of nothing, the first is undecided
    result = one;
  } else {
    result.hi = std::nextafter(first + two.hi, INFINITY);
  }
  return result;
}

/// Whether a contact can lie in both brackets, or be missing from both. `undecided` agrees with what lies beyond its
/// lo.
bool agree(const Result& one, const Result& other) {
  if (meets(one) && meets(other)) return one.lo <= other.hi && other.lo <= one.hi;
  if (meets(one) || meets(other)) {
    const Result& found = meets(one) ? one : other;
    const Result& missing = meets(one) ? other : one;
    return missing.status == Status::undecided && missing.lo <= found.hi;
  }
  return one.status != Status::invalid && other.status != Status::invalid;
}

class Answering {
 public:
  std::vector<Result> answer(const Approach& asked, const std::vector<HardCase>& cases) {
    const Workload workload = sceneOf(cases, Company::isolated);
    replaceBy(workload, 0, scene_);
    return sweeper_.run(queriesOf(workload.queries, asked.resolution), asked.mode()).results;
  }

  std::vector<Result> answerChanged(const Approach& asked, const Change& change, const std::vector<HardCase>& cases,
                                    Random random) {
    std::vector<HardCase> changed, rest;
    for (const HardCase& hard : cases) {
      if (change.apply != nullptr) {
        changed.push_back(change.apply(hard, random));
        continue;
      }
      const std::array<HardCase, 2> parts = splitWay(hard, random);
      changed.push_back(parts[0]);
      rest.push_back(parts[1]);
    }
    std::vector<Result> answers = answer(asked, changed);
    if (rest.empty()) return answers;
    const std::vector<Result> second = answer(asked, rest);
    for (size_t i = 0; i < cases.size(); ++i) answers[i] = joined(answers[i], second[i], changed[i].distance);
    return answers;
  }

 private:
  Scene scene_;
  Sweeper sweeper_{test::device(), scene_, {.cpuBatch = 0}};
};

std::vector<HardCase> dyadicCases(uint64_t seed) {
  std::vector<HardCase> cases;
  for (uint32_t i = 0; i < kIsolatedCases; ++i) {
    Random random(seed * 1'000'003 + i);
    cases.push_back(dyadicCase(random));
  }
  return cases;
}

Result answered(Status status, double lo, double hi) {
  return test::madeUpAnswer(status, NAN, lo, hi);
}

Result exactAnswer(const HardCase& hard) {
  const Workload workload = sceneOf({hard}, Company::isolated);
  Scene scene;
  replaceBy(workload, 0, scene);
  return test::answer(scene, workload.queries[0]);
}

}  // namespace

TEST_CASE("two answers agree when one contact can be in both brackets") {
  const Result hit = answered(Status::hit, 1, 2), clear = answered(Status::clear, NAN, NAN);
  CHECK(agree(hit, answered(Status::hit, 2, 3)));
  CHECK_FALSE(agree(hit, answered(Status::hit, 2.5, 3)));
  CHECK_FALSE(agree(hit, clear));
  CHECK(agree(hit, answered(Status::undecided, 2, NAN)));
  CHECK_FALSE(agree(answered(Status::undecided, 2.5, NAN), hit));
  CHECK(agree(clear, clear));
  CHECK_FALSE(agree(clear, answered(Status::overlap, 0, 0)));
}

TEST_CASE("the changes leave the exact answer where it is, to the bit") {
  uint32_t contacts = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const HardCase hard = dyadicCase(random);
    const Result exact = exactAnswer(hard);
    contacts += exact.status != Status::clear;
    for (const HardCase& changed :
         {movedTogether(hard, random), changedPlaces(hard), cutInTwo(hard, random), withFarObjects(hard, random)}) {
      const Result again = exactAnswer(changed);
      CHECK(again.status == exact.status);
      CHECK(again.t == exact.t);
    }
  }
  CHECK(contacts > 80);
  CHECK(contacts < 180);
}

TEST_CASE("moving, swapping, cutting, adding far objects and splitting D change no answer beyond its bracket") {
  Answering answering;
  for (const uint64_t seed : {5, 6}) {
    const std::vector<HardCase> cases = dyadicCases(seed);
    for (const Approach& asked : kAsked) {
      const std::vector<Result> before = answering.answer(asked, cases);
      CHECK(std::count_if(before.begin(), before.end(), meets) >= 8);
      for (const Change& change : kChanges) {
        const std::vector<Result> after = answering.answerChanged(asked, change, cases, Random(seed * 7'919));
        for (size_t i = 0; i < cases.size(); ++i) {
          CAPTURE(change.name, asked.tier(), seed, i);
          CHECK(agree(before[i], after[i]));
          if (asked.mode() == Mode::contact) CHECK(after[i].status != Status::undecided);
        }
      }
    }
  }
}
