#include "stability/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "stability/table.h"
#include "workloads/stability.h"

namespace radar::tools {

namespace {

constexpr const char* kBeginning = R"(# Where methods fail

This page was written by the command below. It asks every tier about families of cases in which collision queries are
known to go wrong, and holds each answer against the CPU's exact search (`engine/cpu`); mode `contact` is
asked on the device. A family has one parameter; its
cases take the values in turn, in random rotations and positions, and sensor and scene change places in half of the cases
that have one object. `tests/stability` does the same with fewer cases.

)";

constexpr const char* kReading = R"(
How to read the tables:

- **tier, pixels**: `paper` is the paper's literal min(L), which mode `sampled` tells beside its own answer: contact
  after min(L) if that is within D, now if it is negative. `sampled` and `contact` are the modes of the engine. The number is
  the pixels of the scope's longer side. The larger the scope, the fewer of the cases are asked: *cases* counts them.
- **missed**: there is a contact within D, and the answer is that there is none; for `paper` and `sampled` also that
  none was seen. Mode `sampled` then says `undecided`, never `clear`. **false**: a contact is told where there is none within D.
- **late**, **early**: the most that the t told lies after or before the exact one. **width**: the median of hi - lo. All three in units of
  the greater of the sensor's size and t. In mode `sampled` t is the upper end of the bracket.
- **brackets**: brackets that do not hold the exact t. **otherwise**: other promises broken (no answer, wrong status, triangles, point or
  normal). The paper's min(L) has no bracket.
- **select**, **pict.**, **contact %**: the share of cases settled by the tree over objects alone, by pictures, by the exact search;
  **undecided** what is left.
- **us a query**: microseconds, the median over batches of up to 32 queries.

)";

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[800];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::vector<StabilityRow> rowsOf(const StabilityReport& report, const std::string& family) {
  std::vector<StabilityRow> rows;
  std::copy_if(report.rows.begin(), report.rows.end(), std::back_inserter(rows),
               [&](const StabilityRow& row) { return row.family == family; });
  return rows;
}

std::string originOf(const StabilityOrigin& origin) {
  return "    " + origin.command + "\n\n*" + origin.date + ", device " + origin.device + ", driver " + origin.driver +
         ", commit " + origin.commit + ".*\n";
}

std::string summaryOf(const StabilityReport& report) {
  uint64_t contact = 0, missed = 0, falseHits = 0, brackets = 0, otherwise = 0, undecided = 0;
  double error = 0;
  for (const StabilityRow& row : report.rows) {
    if (row.method != Method::contact) continue;
    contact += row.cases;
    missed += row.missed;
    falseHits += row.falseHits;
    brackets += row.brackets;
    otherwise += row.otherwise;
    undecided += row.undecided;
    error = std::max({error, row.late, row.early});
  }
  const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
  const std::string t = error == 0 ? "the CPU's to the bit" : print("within %.1e of the CPU's", error);
  return print(
             "Mode `contact` (%llu answers): %llu missed, %llu false, %llu brackets violated, %llu promises broken "
             "otherwise,\n%llu undecided. Its t was ",
             number(contact), number(missed), number(falseHits), number(brackets), number(otherwise),
             number(undecided)) +
         t +
         " in every family, those whose input is ill-conditioned among them: both\ndecide about the same placed "
         "vertices, without rounding.\n";
}

std::string picturesOf(const std::vector<StabilityPicture>& pictures) {
  std::string text = "\n## How the sampled method fails\n\n";
  text +=
      "One case for each kind of failure, the gravest of its family in this run at 64 pixels. Scopes as in the paper: "
      "R, M, L.\n";
  for (const StabilityPicture& picture : pictures) {
    text += "\n### " + picture.title + "\n\n" + picture.words + "\n\n![" + picture.title + "](" + picture.file + ")\n";
  }
  return text;
}

std::string stepsOf(const std::vector<StepRow>& rows) {
  std::string text =
      "\n## In tiny steps\n\nThe sensor's pose moves in steps of 10^-6 of its size, in one direction a case. *excess*: "
      "the most that t "
      "moved in a\nstep beyond what the exact t did, in the units above; *flips*: steps in which only one of the two "
      "contacts was found; of\nsteps in which the exact search finds both. Pictures have 64 pixels.\n\n| family | "
      "steps |";
  std::string line = "\n|---|---|";
  for (size_t m = 0; m < kMethods; ++m) {
    text += print(" %s excess | flips |", nameOf(static_cast<Method>(m)));
    line += "---|---|";
  }
  text += line;
  std::array<StepRow, kMethods> all;
  for (const StepRow& row : rows) {
    if (row.method == Method::paper) {
      text += print("\n| %s | %llu |", row.family.c_str(), static_cast<unsigned long long>(row.steps));
    }
    text += print(" %.2g | %llu |", row.excess, static_cast<unsigned long long>(row.flips));
    StepRow& sum = all[static_cast<size_t>(row.method)];
    sum.steps += row.steps;
    sum.flips += row.flips;
    sum.excess = std::max(sum.excess, row.excess);
  }
  text += print("\n| **all: the largest** | %llu |", static_cast<unsigned long long>(all[0].steps));
  for (const StepRow& sum : all)
    text += print(" %.2g | %llu |", sum.excess, static_cast<unsigned long long>(sum.flips));
  return text + "\n";
}

std::string changesOf(const std::vector<ChangeRow>& rows) {
  std::string text =
      "\n## Changes that change nothing\n\nWithout a reference: what leaves the first contact where it is, exactly "
      "in float, must leave every answer within its\nbracket. *broken*: the answers before and after cannot both be "
      "right. Pictures have 64 pixels.\n\n| change | tier | cases | contacts found | broken |\n|---|---|---|---|---|\n";
  for (const ChangeRow& row : rows) {
    text += print("| %s | %s | %llu | %llu | %llu |\n", nameOf(row.change), nameOf(row.method),
                  static_cast<unsigned long long>(row.cases), static_cast<unsigned long long>(row.contacts),
                  static_cast<unsigned long long>(row.broken));
  }
  return text;
}

std::string familyOf(const StabilityFamily& family, const std::vector<StabilityRow>& rows) {
  std::string text = "\n### " + family.name + "\n\nParameter: " + family.parameter + ":";
  for (const double value : family.values) text += print(" %g", value);
  return text + ".\n\n" + markdownOf(rows);
}

}  // namespace

std::string pageOf(const StabilityFindings& findings, const StabilityOrigin& origin) {
  std::string text = kBeginning + originOf(origin) + "\n" + summaryOf(findings.report) + kReading;
  text +=
      "## All families\n\nCounts added up, the worst of the worst, medians of the families' medians. Rows as a file: "
      "[table.csv](stability/table.csv).\n\n";
  text += markdownOf(overFamilies(findings.report.rows));
  if (!findings.pictures.empty()) text += picturesOf(findings.pictures);
  text += stepsOf(findings.steps) + changesOf(findings.changes) + "\n## Each family\n";
  for (const StabilityFamily& family : stabilityFamilies()) {
    text += familyOf(family, rowsOf(findings.report, family.name));
  }
  return text;
}

}  // namespace radar::tools
