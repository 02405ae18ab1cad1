#include "chart/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/statistics.h"

namespace radar::tools {

namespace {

// An error that is infinite is known all the same.
double finite(double length) {
  return std::min(std::abs(length), std::numeric_limits<double>::max());
}

}  // namespace

void judge(Cell& cell, std::span<const Claim> claims, std::span<const Result> truth, std::span<const double> sizes) {
  std::vector<double> errors, widths;
  for (size_t i = 0; i < claims.size(); ++i) {
    const Verdict verdict = judge(claims[i], truth[i], sizes[i]);
    const bool isBounded = !std::isnan(claims[i].hi);
    cell.contacts += meets(truth[i]);
    cell.found += verdict.found;
    cell.misses += verdict[Fault::missed] || verdict.unseen;
    cell.falseHits += verdict[Fault::falseHit];
    cell.violations += verdict[Fault::bracket] || (verdict[Fault::falseHit] && isBounded) ||
                       (verdict[Fault::missed] && cell.certified);
    if (!verdict.found) continue;
    errors.push_back(finite(verdict.error));
    if (cell.certified) widths.push_back(finite((claims[i].hi - claims[i].lo) / sizes[i]));
  }
  cell.errorMedian = quantile(errors, 0.5);
  cell.error99 = quantile(errors, 0.99);
  cell.errorWorst = quantile(errors, 1);
  cell.widthMedian = quantile(widths, 0.5);
  cell.width99 = quantile(widths, 0.99);
  cell.widthWorst = quantile(widths, 1);
}

void countTiers(Cell& cell, std::span<const Result> results) {
  const double each = 1 / static_cast<double>(results.size());
  for (const Result& result : results) {
    switch (result.tier) {
      case Tier::select:
        cell.settledSelect += each;
        break;
      case Tier::sampled:
        cell.settledSampled += each;
        break;
      case Tier::contact:
        cell.settledContact += each;
        break;
      case Tier::reference:
        cell.settledReference += each;
        break;
    }
  }
}

}  // namespace radar::tools
