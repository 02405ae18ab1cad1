// A method tried on a case: how long it takes, and how right it is.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "measure/case.h"
#include "measure/method.h"

namespace radar::tools {

/// Preparing once, then a pass over all queries, divided by their number.
struct Times {
  double prepareMs = NAN;
  uint32_t passes = 0;
  double us = NAN, usLow = NAN, usHigh = NAN;  ///< median and quartiles over the passes, microseconds
  double cpuUs = NAN;                          ///< processor time of all threads, in the mean
  double sceneUs = NAN;                        ///< beside it: changing from scene to scene, divided alike
};

/// How right, by the exact answers. Lengths in sizes of the sensor (the greatest extent of its box).
struct Accuracy {
  uint32_t contacts = 0;                                      ///< queries with a contact within D, in truth
  uint32_t found = 0;                                         ///< contacts for which a distance was reported
  uint32_t misses = 0;                                        ///< contacts denied or not seen
  uint32_t falseHits = 0;                                     ///< no contact in truth, but one reported
  uint32_t violations = 0;                                    ///< bounds, and certain "none"s, that do not hold
  bool certified = false;                                     ///< Method::certified
  double errorMedian = NAN, error99 = NAN, errorWorst = NAN;  ///< of what was found
  double widthWorst = NAN;                                    ///< of the brackets of what was found
};

/// What was measured of one method on one case: a row of the table.
struct Cell : Times, Accuracy {
  std::string section, workload;  ///< of the case
  double x = 0;
  std::string method, family;
  uint32_t size = 0, threads = 0;
  uint32_t queries = 0;
  std::string failed;  ///< why there are no numbers; empty: there are

  /// Share of answers that are wrong: a contact missed, or reported where there is none.
  double wrongShare() const { return static_cast<double>(misses + falseHits) / queries; }
};

/// Calls visit(name, member) for each column, in the order of the table.
template <class SomeCell, class Visit>
void eachColumn(SomeCell& cell, const Visit& visit) {
  visit("section", cell.section);
  visit("workload", cell.workload);
  visit("x", cell.x);
  visit("method", cell.method);
  visit("family", cell.family);
  visit("size", cell.size);
  visit("threads", cell.threads);
  visit("queries", cell.queries);
  visit("failed", cell.failed);
  visit("prepare_ms", cell.prepareMs);
  visit("passes", cell.passes);
  visit("us_median", cell.us);
  visit("us_quartile_1", cell.usLow);
  visit("us_quartile_3", cell.usHigh);
  visit("cpu_us", cell.cpuUs);
  visit("scene_us", cell.sceneUs);
  visit("contacts", cell.contacts);
  visit("found", cell.found);
  visit("misses", cell.misses);
  visit("false_hits", cell.falseHits);
  visit("violations", cell.violations);
  visit("certified", cell.certified);
  visit("error_median", cell.errorMedian);
  visit("error_99", cell.error99);
  visit("error_worst", cell.errorWorst);
  visit("width_worst", cell.widthWorst);
}

/// Of a workload, query by query in the order of its batches.
struct Truth {
  std::vector<Result> answers;  ///< the CPU's
  std::vector<double> sizes;    ///< of the sensors
};
Truth truthOf(const Workload& workload);

/// How right the answers are; `certified`: as Method.
Accuracy accuracyOf(std::span<const Result> answers, const Truth& truth, bool certified);

/// The whole question, whatever the file says of modes. `workload`, `truth`: of the case. A method that is apart may
/// fail, and Cell::failed says how.
Cell tryOut(const Case& which, const Workload& workload, const Method& method, const Truth& truth,
            const Repetition& repetition);

}  // namespace radar::tools
