// A run on disk: chart.csv, from which an interrupted run goes on and everything else is drawn again.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace radar::tools {

/// What was measured of one method on one workload: a row of the file.
struct Cell {
  std::string section;  ///< front, table1 or growth
  std::string workload;
  double x = 0;        ///< where on its section's axis; 0 in section front
  std::string method;  ///< family and size: "sampled 64"
  std::string family;
  uint32_t size = 0;     ///< resolution or steps; 0: the family has one member
  uint32_t threads = 0;  ///< 0: as many as the device takes
  uint32_t queries = 0;
  std::string failed;  ///< why there are no numbers; empty: there are

  // How long: preparing once, then a pass over all queries, divided by their number.
  double prepareMs = NAN;
  uint32_t passes = 0;
  double us = NAN, usLow = NAN, usHigh = NAN;  ///< median and quartiles over the passes, microseconds
  double cpuUs = NAN;                          ///< processor time of all threads, in the mean
  double sceneUs = NAN;                        ///< beside it: changing from scene to scene, divided alike

  // How right, by the exact answers. Lengths in sizes of the sensor (the greatest extent of its box), of a point in the
  // unit of its coordinates.
  uint32_t contacts = 0;    ///< queries with a contact within D, in truth
  uint32_t found = 0;       ///< contacts for which a distance was reported
  uint32_t misses = 0;      ///< contacts denied or not seen
  uint32_t falseHits = 0;   ///< no contact in truth, but one reported
  uint32_t violations = 0;  ///< bounds, and certain "none"s, that do not hold
  bool certified = false;   ///< the method tells a bracket, and "none" only where that is certain
  double errorMedian = NAN, error99 = NAN, errorWorst = NAN;  ///< of what was found
  double widthWorst = NAN;                                    ///< of the brackets of what was found

  /// Share of answers that are wrong: a contact missed, or reported where there is none.
  double wrongShare() const { return static_cast<double>(misses + falseHits) / queries; }
};

/// Calls visit(name, member) for each column, in the order of the file.
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

struct Record {
  /// Lines "key: value" that say where the cells come from. Of several lines: `workload`, for each of section front its
  /// name and what it is, "name: about"; `library`, what each baseline cannot do.
  std::vector<std::string> head;
  std::vector<Cell> cells;

  void add(const std::string& key, const std::string& value);
  std::vector<std::string> values(const std::string& key) const;
};

/// The head's lines begin with #, the next names the columns, each other is a cell.
std::string csvOf(const Record& record);
/// Throws InputError that names the file, the place and what was expected.
Record recordFrom(const std::string& csv, const std::string& file);

/// Nothing where the folder holds no chart.csv.
std::optional<Record> readRecord(const std::filesystem::path& folder);
void writeRecord(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
