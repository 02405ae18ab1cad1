// What a machine's devices are, whether they calculate and answer as they should, and how fast: part by part, so that
// what is known can be written at any time.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "radar/arithmetic.h"
#include "stability/case_run.h"

namespace radar::tools {

/// A part of the test of one device, in the order in which they are made.
enum class Part { arithmetic, exactness, throughput, stages, lanes, passes };
inline constexpr std::array kParts{Part::arithmetic, Part::exactness, Part::throughput,
                                   Part::stages,     Part::lanes,     Part::passes};
const char* nameOf(Part part);

enum class PartState {
  notBegun,
  running,  ///< as long as it runs, and for good where the program ended in it
  done,
  cut,     ///< the time was up: what is there was measured
  failed,  ///< an error: PartReport::note
  impossible
};
const char* nameOf(PartState state);

struct PartReport {
  PartState state = PartState::notBegun;
  std::string note;
  double seconds = 0;
};

/// Hard cases of one family, held against the CPU's exact answers.
struct ExactnessRow {
  std::string family;
  bool doubles = false;  ///< the device used them
  Tally tally;
};

/// Batches of one size: microseconds a query, medians.
struct ThroughputRow {
  std::string workload;
  uint64_t batch = 0;
  double deviceUs = 0;  ///< the device's search, forced
  double cpuUs = 0;     ///< the exact search on all cores
  uint64_t differ = 0;  ///< answers of the two that are not the same
};

/// Where the time of a batch goes, on the device and on the thread that feeds it.
struct StageRow {
  std::string workload;
  std::string stage;
  double us = 0;  ///< a query
};

/// How fast one way is beside another.
struct LaneRow {
  std::string way;
  double us = 0;     ///< a query
  double times = 0;  ///< as fast as the first row
};

struct DeviceTest {
  uint32_t number = 0;  ///< in listDevices()
  DeviceReport facts;
  bool usesDoubles = false;
  std::array<PartReport, kParts.size()> parts;
  std::vector<ArithmeticCheck> arithmetic;
  std::vector<ExactnessRow> exactness;
  std::vector<ThroughputRow> throughput;
  std::vector<StageRow> stages;  ///< of the exact search
  std::vector<LaneRow> lanes;
  std::vector<StageRow> passes;  ///< of the paper's method

  PartReport& operator[](Part part) { return parts[static_cast<size_t>(part)]; }
  const PartReport& operator[](Part part) const { return parts[static_cast<size_t>(part)]; }
  uint64_t wrongAnswers() const;
  uint64_t checkedAnswers() const;
  /// Nothing that was tried is wrong, and no part failed.
  bool right() const;
};

struct SelftestReport {
  std::string command, commit, date, processor;
  double minutes = 0;
  double seconds = 0;  ///< since it began
  std::vector<DeviceTest> devices;
  PartReport togetherState;       ///< of all devices at once; impossible where there is one
  std::vector<LaneRow> together;  ///< each device alone, then all

  bool right() const;
};

struct SelftestSettings {
  std::vector<uint32_t> devices;  ///< in listDevices(); none: all usable ones
  double minutes = 5;             ///< in all
};

/// Fills in the facts of every device asked for. Throws Error if one does not exist or is named twice, or if none is
/// usable. A device that is not usable stays in the report, with its reasons.
void lookAtDevices(const SelftestSettings& settings, SelftestReport& report);

/// Makes every part on every usable device of `report`; `onChange` is called whenever a part begins or ends.
void runSelftest(SelftestReport& report, const std::function<void()>& onChange);

/// What a device is and what it lacks, as in textOf().
std::string factsOf(const DeviceTest& device);
std::string textOf(const SelftestReport& report);
std::string jsonOf(const SelftestReport& report);
std::string arithmeticCsv(const SelftestReport& report);
std::string exactnessCsv(const SelftestReport& report);
std::string throughputCsv(const SelftestReport& report);
std::string stagesCsv(const SelftestReport& report);
std::string htmlOf(const SelftestReport& report);

}  // namespace radar::tools
