#include "chart/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/statistics.h"

namespace radar::tools {

Told toldBy(const Result& result) {
  switch (result.status) {
    case Status::hit:
    case Status::overlap:
      return {Told::Kind::contact, result.t, result.lo, result.hi};
    case Status::clear:
      return {Told::Kind::none, NAN, NAN, NAN};
    case Status::undecided:
      return {Told::Kind::unseen, NAN, NAN, NAN};
    case Status::invalid:
      break;
  }
  throw Error("a query was not answered: a time without its answers says nothing");
}

namespace {

// Finite, so that it is not taken for an error that is not known.
double inSizes(double length, double size) {
  return std::min(std::abs(length) / size, std::numeric_limits<double>::max());
}

}  // namespace

void judge(Cell& cell, std::span<const Told> told, std::span<const Result> truth, std::span<const double> sizes) {
  std::vector<double> errors, widths;
  for (size_t i = 0; i < told.size(); ++i) {
    const bool contact = truth[i].status != Status::clear;
    cell.contacts += contact;
    switch (told[i].kind) {
      case Told::Kind::contact:
        if (!contact) {
          ++cell.falseHits;
          cell.violations += !std::isnan(told[i].hi);
          break;
        }
        ++cell.found;
        errors.push_back(inSizes(told[i].t - truth[i].t, sizes[i]));
        if (cell.certified) widths.push_back(inSizes(told[i].hi - told[i].lo, sizes[i]));
        cell.violations += told[i].lo > truth[i].hi || told[i].hi < truth[i].lo;
        break;
      case Told::Kind::none:
        cell.misses += contact;
        cell.violations += cell.certified && contact;
        break;
      case Told::Kind::unseen:
        cell.misses += contact;
        break;
    }
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
