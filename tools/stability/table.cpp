#include "stability/table.h"

#include <algorithm>
#include <cmath>

#include "bench/statistics.h"
#include "report/print.h"

namespace radar::tools {

namespace {

unsigned long long whole(uint64_t value) {
  return value;
}

/// "" for what does not exist; what is nothing but rounding in few digits.
std::string length(double value) {
  if (std::isnan(value)) return "";
  return value == 0 ? "0" : print("%.2g", value);
}

std::string share(uint64_t part, uint64_t of) {
  if (part == 0) return "0";
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(of);
  return percent < 99.95 && percent >= 0.05 ? print("%.1f", percent) : print("%.3g", percent);
}

std::vector<std::string> cellsOf(const StabilityRow& row) {
  const bool paper = row.method == Method::paper;
  const auto count = [](uint64_t value) { return print("%llu", whole(value)); };
  const auto promised = [&](uint64_t value) { return paper ? "" : count(value); };
  const auto settled = [&](uint64_t value) { return paper ? "" : share(value, row.cases); };
  return {tierOf(row),
          count(row.cases),
          count(row.contacts),
          count(row.missed),
          count(row.falseHits),
          length(row.late),
          length(row.early),
          promised(row.brackets),
          promised(row.otherwise),
          length(row.width),
          settled(row.bySelect),
          settled(row.byPictures),
          settled(row.byContact),
          settled(row.undecided),
          paper ? "" : print("%.0f", row.microseconds)};
}

const std::vector<std::string> kHeads{"tier, pixels", "cases",   "contacts",  "missed",      "false",
                                      "late",         "early",   "brackets",  "otherwise",   "width",
                                      "select %",     "pict. %", "contact %", "undecided %", "us a query"};

double medianOfNumbers(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return median(std::move(values));
}

}  // namespace

std::string tierOf(const StabilityRow& row) {
  return row.method == Method::contact ? "contact" : print("%s %u", nameOf(row.method), row.resolution);
}

std::string csvOf(const std::vector<StabilityRow>& rows) {
  std::string text =
      "family,tier,resolution,cases,contacts,missed,false,brackets_violated,otherwise_wrong,late_worst,early_worst,"
      "width_median,by_select,by_pictures,by_contact,undecided,us_median\n";
  for (const StabilityRow& row : rows) {
    text += print("%s,%s,%u,%llu,%llu,%llu,%llu,%llu,%llu,", row.family.c_str(), nameOf(row.method), row.resolution,
                  whole(row.cases), whole(row.contacts), whole(row.missed), whole(row.falseHits), whole(row.brackets),
                  whole(row.otherwise));
    text += print("%.6g,%.6g,%.6g,%llu,%llu,%llu,%llu,%.2f\n", row.late, row.early, row.width, whole(row.bySelect),
                  whole(row.byPictures), whole(row.byContact), whole(row.undecided), row.microseconds);
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

std::string csvOf(const std::vector<StabilityFamily>& families) {
  std::string text = "family,parameter,values\n";
  for (const StabilityFamily& family : families) {
    text += family.name + ",\"" + family.parameter + "\",";
    for (const double& value : family.values) text += print(&value == &family.values.front() ? "%g" : " %g", value);
    text += "\n";
  }
  return text;
}

std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows) {
  std::vector<StepRow> all;
  for (const StepRow& row : rows) {
    auto sum = std::find_if(all.begin(), all.end(), [&](const StepRow& one) { return one.method == row.method; });
    if (sum == all.end()) sum = all.insert(sum, {.family = "all", .method = row.method});
    sum->steps += row.steps;
    sum->flips += row.flips;
    sum->excess = std::max(sum->excess, row.excess);
  }
  return all;
}

std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows) {
  std::vector<StabilityRow> all;
  std::vector<std::vector<double>> widths, times;
  for (const StabilityRow& row : rows) {
    const auto same = [&](const StabilityRow& r) { return r.method == row.method && r.resolution == row.resolution; };
    const auto found = std::find_if(all.begin(), all.end(), same);
    const auto at = static_cast<size_t>(found - all.begin());
    if (found == all.end()) {
      all.emplace_back();
      all.back().family = "all";
      all.back().method = row.method;
      all.back().resolution = row.resolution;
      widths.emplace_back();
      times.emplace_back();
    }
    StabilityRow& sum = all[at];
    for (uint64_t StabilityRow::*number :
         {&StabilityRow::cases, &StabilityRow::contacts, &StabilityRow::missed, &StabilityRow::falseHits,
          &StabilityRow::brackets, &StabilityRow::otherwise, &StabilityRow::bySelect, &StabilityRow::byPictures,
          &StabilityRow::byContact, &StabilityRow::undecided}) {
      sum.*number += row.*number;
    }
    sum.late = std::max(sum.late, row.late);
    sum.early = std::max(sum.early, row.early);
    widths[at].push_back(row.width);
    times[at].push_back(row.microseconds);
  }
  for (size_t i = 0; i < all.size(); ++i) {
    all[i].width = medianOfNumbers(widths[i]);
    all[i].microseconds = medianOfNumbers(times[i]);
  }
  return all;
}

std::string tableOf(const std::vector<StabilityRow>& rows) {
  std::string text;
  for (const std::string& head : kHeads) text += print("%*s", head == kHeads[0] ? -14 : 12, head.c_str());
  for (const StabilityRow& row : rows) {
    const std::vector<std::string> cells = cellsOf(row);
    text += "\n";
    for (size_t i = 0; i < cells.size(); ++i) text += print("%*s", i == 0 ? -14 : 12, cells[i].c_str());
  }
  return text + "\n";
}

}  // namespace radar::tools
