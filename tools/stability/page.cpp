#include "stability/page.h"

#include <algorithm>
#include <cmath>

#include "report/print.h"
#include "stability/table.h"
#include "workloads/stability.h"

namespace radar::tools {

namespace {

constexpr const char* kReading = R"(
`paper` is the paper's literal min(L), which mode `sampled` reports beside its own answer. *Missed*: contacts that the tier
denies or does not see; mode `sampled` then says `undecided`, never `clear`. *Late*, *early*: the largest errors of reported
distances, in units of the greater of the sensor's size and the distance. All rows: [table.csv](stability/table.csv).
What each family varies: [families.csv](stability/families.csv).
)";

unsigned long long whole(uint64_t value) {
  return value;
}

std::string beginningOf(const StabilityOrigin& origin) {
  return print(
             "# Where methods fail\n\nSome situations break collision queries: thin and edge-on shapes, "
             "exact "
             "touching, gaps of one rounding, great\ndistances, concave shapes inside each other. This "
             "command asks every tier about %zu families of such cases and\ncompares each answer with the CPU's exact "
             "search; mode `contact` runs on the device:\n\n",
             stabilityFamilies().size()) +
         "    " + origin.command + "\n\n*" + origin.date + ", device " + origin.device + ", driver " + origin.driver +
         ", commit " + origin.commit + "*\n\n";
}

std::string summaryOf(const StabilityReport& report) {
  StabilityRow all;
  double error = 0;
  for (const StabilityRow& row : report.rows) {
    if (row.method != Method::contact) continue;
    for (uint64_t StabilityRow::*number :
         {&StabilityRow::cases, &StabilityRow::missed, &StabilityRow::falseHits, &StabilityRow::brackets,
          &StabilityRow::otherwise, &StabilityRow::undecided}) {
      all.*number += row.*number;
    }
    error = std::max({error, row.late, row.early});
  }
  const std::string distances =
      error == 0 ? "equals the CPU's to the bit" : print("is within %.1e of the CPU's", error);
  return print(
             "Mode `contact` gave %llu answers: %llu contacts missed, %llu invented, %llu brackets violated, %llu "
             "other promises\nbroken, %llu undecided. Every distance ",
             whole(all.cases), whole(all.missed), whole(all.falseHits), whole(all.brackets), whole(all.otherwise),
             whole(all.undecided)) +
         distances + ".\n\n";
}

std::string tableOf(const StabilityReport& report) {
  std::string text = "| tier, pixels | contacts | missed | invented | late | early |\n|---|--:|--:|--:|--:|--:|\n";
  for (const StabilityRow& row : overFamilies(report.rows)) {
    text += print("| %s | %llu | %llu | %llu | %.2g | %.2g |\n", tierOf(row).c_str(), whole(row.contacts),
                  whole(row.missed), whole(row.falseHits), row.late, row.early);
  }
  return text;
}

std::string picturesOf(const std::vector<StabilityPicture>& pictures) {
  std::string text =
      print("\n## How sampling fails\n\nThe worst case of each kind at %u pixels.\n", kTellingResolution);
  for (const StabilityPicture& picture : pictures) {
    text += "\n**" + picture.title + ".** " + picture.words + "\n\n![R, M and L](" + picture.file + ")\n";
  }
  return text;
}

std::string stepsOf(const std::vector<StepRow>& rows) {
  const std::vector<StepRow> sums = overFamilies(rows);
  std::string text = print(
      "\n## In tiny steps\n\nThe sensor moves in %llu steps of a millionth of its size. *Flips*: steps at which only "
      "one "
      "of two contacts is found. *Excess*:\nthe most that a distance changes beyond the change of the exact one "
      "([steps.csv](stability/steps.csv)).\n\n",
      whole(sums.empty() ? 0 : sums.front().steps));
  for (const StepRow& sum : sums) {
    text += print("- `%s`: %llu flips, excess %.2g\n", nameOf(sum.method), whole(sum.flips), sum.excess);
  }
  return text;
}

std::string changesOf(const std::vector<ChangeRow>& rows) {
  uint64_t cases = 0, broken = 0;
  for (const ChangeRow& row : rows) {
    cases += row.cases;
    broken += row.broken;
  }
  return print(
      "\n## Changes that change nothing\n\nMoving everything together, swapping sensor and object, cutting triangles, "
      "adding far objects and splitting the distance leave\nthe first contact where it is. Of %llu pairs of answers "
      "before and after, %llu are contradictory\n([changes.csv](stability/changes.csv)).\n",
      whole(cases), whole(broken));
}

}  // namespace

std::string pageOf(const StabilityFindings& findings, const StabilityOrigin& origin) {
  std::string text = beginningOf(origin) + summaryOf(findings.report) + tableOf(findings.report) + kReading;
  if (!findings.pictures.empty()) text += picturesOf(findings.pictures);
  return text + stepsOf(findings.steps) + changesOf(findings.changes);
}

}  // namespace radar::tools
