#include "stability/table.h"

#include <algorithm>
#include <functional>

#include "report/print.h"

namespace radar::tools {

namespace {

unsigned long long whole(uint64_t value) {
  return value;
}

/// The row of `all` for which `isSame` holds; a new one if there is none.
template <class Row>
Row& sumOf(std::vector<Row>& all, const Row& empty, const std::function<bool(const Row&)>& isSame) {
  const auto found = std::find_if(all.begin(), all.end(), isSame);
  return found != all.end() ? *found : all.emplace_back(empty);
}

/// Faults that have no column of their own.
uint64_t otherFaults(const Tally& tally) {
  uint64_t sum = 0;
  for (const Fault fault :
       {Fault::unanswered, Fault::wrongStatus, Fault::wrongPair, Fault::late, Fault::point, Fault::normal}) {
    sum += tally[fault];
  }
  return sum;
}

}  // namespace

std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows) {
  std::vector<StabilityRow> all;
  for (const StabilityRow& row : rows) {
    StabilityRow& sum = sumOf<StabilityRow>(
        all, {"all", row.asked, {}}, [&](const StabilityRow& one) { return one.asked.name() == row.asked.name(); });
    sum.tally.add(row.tally);
  }
  return all;
}

std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows) {
  std::vector<StepRow> all;
  for (const StepRow& row : rows) {
    StepRow& sum = sumOf<StepRow>(all, {.family = "all", .method = row.method},
                                  [&](const StepRow& one) { return one.method == row.method; });
    sum.steps += row.steps;
    sum.flips += row.flips;
    sum.excess = std::max(sum.excess, row.excess);
  }
  return all;
}

std::string csvOf(const std::vector<StabilityRow>& rows) {
  std::string text =
      "family,tier,resolution,cases,contacts,missed,false,brackets_violated,otherwise_wrong,late,early\n";
  for (const StabilityRow& row : rows) {
    const Tally& t = row.tally;
    text += print("%s,%s,%u,%llu,%llu,%llu,%llu,%llu,%llu,%.6g,%.6g\n", row.family.c_str(), nameOf(row.asked.method),
                  row.asked.resolution, whole(t.queries), whole(t.contacts()), whole(row.missed()),
                  whole(t[Fault::falseHit]), whole(t[Fault::bracket]), whole(otherFaults(t)), t.late, t.early);
  }
  return text;
}

std::string csvOf(const std::vector<StepRow>& rows) {
  std::string text = "family,tier,steps,flips,excess\n";
  for (const StepRow& row : rows) {
    text += print("%s,%s,%llu,%llu,%.2g\n", row.family.c_str(), nameOf(row.method), whole(row.steps), whole(row.flips),
                  row.excess);
  }
  return text;
}

std::string csvOf(const std::vector<ChangeRow>& rows) {
  std::string text = "change,tier,cases,contacts,broken\n";
  for (const ChangeRow& row : rows) {
    text += print("%s,%s,%llu,%llu,%llu\n", nameOf(row.change), nameOf(row.method), whole(row.cases),
                  whole(row.contacts), whole(row.broken));
  }
  return text;
}

std::string csvOf(const std::vector<HardFamily>& families) {
  std::string text = "family,parameter,values\n";
  for (const HardFamily& family : families) {
    text += family.name + ",\"" + family.parameter + "\",";
    for (const double& value : family.values) text += print(&value == &family.values.front() ? "%g" : " %g", value);
    text += "\n";
  }
  return text;
}

std::string tableOf(const std::vector<StabilityRow>& rows) {
  std::string text = print("%-14s%9s%9s%9s%9s%9s%9s%9s%9s\n", "tier, pixels", "cases", "contacts", "missed", "false",
                           "brackets", "other", "late", "early");
  for (const StabilityRow& row : rows) {
    const Tally& t = row.tally;
    text += print("%-14s%9llu%9llu%9llu%9llu%9llu%9llu%9.2g%9.2g\n", row.asked.name().c_str(), whole(t.queries),
                  whole(t.contacts()), whole(row.missed()), whole(t[Fault::falseHit]), whole(t[Fault::bracket]),
                  whole(otherFaults(t)), t.late, t.early);
  }
  return text;
}

}  // namespace radar::tools
