#include "stability/measure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "workloads/same_contact.h"

namespace radar::tools {

namespace {

constexpr size_t kTiers = 2;  // sampled and contact

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

class Comparing {
 public:
  Comparing(const Device& device, const ChangeSettings& settings) : sweeper_(device, scene_), settings_(settings) {}

  /// By method, by case.
  using Answers = std::array<std::vector<Result>, kTiers>;
  Answers answer(const std::vector<HardCase>& cases) {
    const Workload workload = sceneOf(cases, Company::isolated);
    replaceBy(workload, 0, scene_);
    const std::vector<Query> queries = queriesOf(workload.queries);
    Answers answers;
    answers[0] = answersBy({settings_.resolution}, sweeper_, queries);
    answers[1] = answersBy({}, sweeper_, queries);
    return answers;
  }

  Answers answerChanged(const Change& change, const std::vector<HardCase>& cases, Random& random) {
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
    Answers answers = answer(changed);
    if (rest.empty()) return answers;
    const Answers second = answer(rest);
    for (size_t m = 0; m < kTiers; ++m) {
      for (size_t i = 0; i < cases.size(); ++i) {
        answers[m][i] = joined(answers[m][i], second[m][i], changed[i].distance);
      }
    }
    return answers;
  }

 private:
  Scene scene_;
  Sweeper sweeper_;
  const ChangeSettings& settings_;
};

}  // namespace

bool agree(const Result& one, const Result& other) {
  if (meets(one) && meets(other)) return one.lo <= other.hi && other.lo <= one.hi;
  if (meets(one) || meets(other)) {
    const Result& found = meets(one) ? one : other;
    const Result& missing = meets(one) ? other : one;
    return missing.status == Status::undecided && missing.lo <= found.hi;
  }
  return one.status != Status::invalid && other.status != Status::invalid;
}

std::vector<ChangeRow> measureChanges(const Device& device, const ChangeSettings& settings,
                                      const std::function<void(const std::string&)>& onBroken,
                                      const std::function<void(uint64_t)>& onProgress) {
  Comparing comparing(device, settings);
  std::vector<ChangeRow> rows;
  for (const Change& change : kChanges) {
    rows.push_back({change.name, {settings.resolution}});
    rows.push_back({change.name});
  }
  for (uint32_t next = 0; next < settings.cases; next += kIsolatedCases) {
    std::vector<HardCase> cases;
    const uint32_t end = std::min(settings.cases, next + kIsolatedCases);
    for (uint32_t i = next; i < end; ++i) {
      Random random(settings.seed * 1'000'003 + i);
      cases.push_back(dyadicCase(random));
    }
    Random random(settings.seed * 7'919 + next);
    const Comparing::Answers before = comparing.answer(cases);
    for (size_t c = 0; c < std::size(kChanges); ++c) {
      const Comparing::Answers after = comparing.answerChanged(kChanges[c], cases, random);
      for (size_t m = 0; m < kTiers; ++m) {
        ChangeRow& row = rows[c * kTiers + m];
        for (size_t i = 0; i < cases.size(); ++i) {
          ++row.cases;
          row.contacts += meets(before[m][i]);
          const bool undecided = row.asked.resolution == 0 && after[m][i].status == Status::undecided;
          if (agree(before[m][i], after[m][i]) && !undecided) continue;
          ++row.broken;
          onBroken(row.change + ", " + row.asked.tier() + ", case " + std::to_string(next + i));
        }
      }
    }
    onProgress(end - next);
  }
  return rows;
}

}  // namespace radar::tools
