#include "stability/measure.h"

#include <algorithm>
#include <iterator>

namespace radar::tools {

namespace {

/// Rows of one key become one row of the family `all`.
template <class Row, class KeyOf, class Add>
std::vector<Row> sums(const std::vector<Row>& rows, const KeyOf& keyOf, const Add& add) {
  std::vector<Row> all;
  for (const Row& row : rows) {
    const auto sum = std::find_if(all.begin(), all.end(), [&](const Row& one) { return keyOf(one) == keyOf(row); });
    if (sum != all.end()) {
      add(*sum, row);
    } else {
      all.emplace_back(row).family = "all";
    }
  }
  return all;
}

}  // namespace

std::vector<StabilityRow> measureStability(const Device& device, const StabilitySettings& settings,
                                           const std::function<void(const std::string&)>& onWrong,
                                           const std::function<void(uint64_t)>& onProgress) {
  std::vector<std::string> families = settings.families;
  if (families.empty()) {
    for (const HardFamily& family : hardFamilies()) families.push_back(family.name);
  }
  std::vector<Approach> all;
  for (const uint32_t resolution : settings.resolutions) {
    all.push_back({resolution, true});
    all.push_back({resolution});
  }
  all.emplace_back();
  const uint64_t each = (settings.cases + families.size() - 1) / families.size();
  CaseRun run(device);
  std::vector<StabilityRow> rows;
  for (const std::string& family : families) {
    std::vector<Approach> asked;
    std::copy_if(all.begin(), all.end(), std::back_inserter(asked),
                 [&](const Approach& one) { return one.resolution == 0 || offersSampled(hardFamily(family)); });
    const auto tell = [&](uint64_t number, const Approach& who, const std::string& words) {
      onWrong(who.tier() + (" " + std::to_string(who.resolution)) + ": " + words + "; --family \"" + family +
              "\" --seed " + std::to_string(settings.seed) + " --first " + std::to_string(number) + " --cases 1");
    };
    const std::vector<Tally> tallies =
        run.run({family, settings.seed, settings.first, each, Company::isolated}, asked, tell, onProgress);
    for (size_t i = 0; i < asked.size(); ++i) rows.push_back({family, asked[i], tallies[i]});
  }
  return rows;
}

std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows) {
  return sums(
      rows, [](const StabilityRow& row) { return std::pair(row.asked.resolution, row.asked.paper); },
      [](StabilityRow& sum, const StabilityRow& row) { sum.tally.add(row.tally); });
}

std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows) {
  return sums(
      rows, [](const StepRow& row) { return std::string(row.asked.tier()); },
      [](StepRow& sum, const StepRow& row) {
        sum.steps += row.steps;
        sum.flips += row.flips;
        sum.excess = std::max(sum.excess, row.excess);
      });
}

Json tableOf(const std::vector<StabilityRow>& rows) {
  Json table = Json::array();
  for (const StabilityRow& row : rows) {
    const Tally& t = row.tally;
    const uint64_t other = t[Fault::unanswered] + t[Fault::wrongStatus] + t[Fault::wrongPair] + t[Fault::wrongList] +
                           t[Fault::late] + t[Fault::point] + t[Fault::normal];
    table.push_back({{"family", row.family},
                     {"tier", row.asked.tier()},
                     {"resolution", row.asked.resolution},
                     {"cases", t.queries},
                     {"contacts", t.contacts()},
                     {"missed", row.missed()},
                     {"false", t[Fault::falseHit]},
                     {"brackets_violated", t[Fault::bracket]},
                     {"otherwise_wrong", other},
                     {"late", t.late},
                     {"early", t.early}});
  }
  return table;
}

Json tableOf(const std::vector<StepRow>& rows) {
  Json table = Json::array();
  for (const StepRow& row : rows) {
    table.push_back({{"family", row.family},
                     {"tier", row.asked.tier()},
                     {"steps", row.steps},
                     {"flips", row.flips},
                     {"excess", row.excess}});
  }
  return table;
}

Json tableOf(const std::vector<ChangeRow>& rows) {
  Json table = Json::array();
  for (const ChangeRow& row : rows) {
    table.push_back({{"change", row.change},
                     {"tier", row.asked.tier()},
                     {"cases", row.cases},
                     {"contacts", row.contacts},
                     {"broken", row.broken}});
  }
  return table;
}

Json tableOf(const std::vector<HardFamily>& families) {
  Json table = Json::array();
  for (const HardFamily& family : families) {
    std::string values;
    for (const double& value : family.values)
      values += (&value == &family.values.front() ? "" : " ") + print("%g", value);
    table.push_back({{"family", family.name}, {"parameter", family.parameter}, {"values", values}});
  }
  return table;
}

}  // namespace radar::tools
