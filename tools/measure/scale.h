// How a workload scales over devices: each device alone, and the first 1, 2, ... of them together, timed and profiled.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/report.h"
#include "radar/pool.h"
#include "workloads/workload.h"

namespace radar::tools {

/// A workload for one place on the axis of sensors.
struct ScalePoint {
  double sensors = 0;  ///< of a batch, in the mean
  Workload workload;
};

struct ScaleSettings {
  Mode mode = Mode::sampled;
  bool select = true;  ///< false: every object is drawn for every sensor
  uint32_t resolution = 0;
  uint32_t repeats = 5;  ///< passes that are timed, after one that is not
};

/// What one device did in one pass, milliseconds.
struct DeviceShare {
  uint32_t queries = 0, chunks = 0;
  uint32_t leastChunk = 0, mostChunk = 0;   ///< queries
  double busy = 0;                          ///< some chunk was with the device, as its thread saw it
  double start = 0;                         ///< idle from a batch's submission to the first chunk's
  double gap = 0;                           ///< idle between chunks
  double tail = 0;                          ///< idle after its last chunk while the batch went on
  double encode = 0, wait = 0, decode = 0;  ///< of its thread
};

/// One set of devices on one point.
struct ScaleRun {
  std::vector<uint32_t> devices;  ///< places in ScaleReport::numbers
  size_t point = 0;
  double ms = 0, least = 0, most = 0;  ///< of a pass over all batches: the median, and the range
  double cores = 0;                    ///< processor time of this process over the time passed
  double scene = 0;                    ///< between batches: the scene is edited
  // Of the pass whose time is the median:
  std::vector<DeviceShare> shares;
  std::vector<PoolAnswers> batches;  ///< without results
  std::vector<StageTime> stages;     ///< of a pass of its own, with timestamps; for the last point only
};

struct ScaleReport {
  std::vector<uint32_t> numbers;  ///< of the devices, as the program lists them
  std::vector<double> sensors;    ///< by point
  std::vector<size_t> batches, queries;
  std::vector<ScaleRun> runs;  ///< point by point: the first 1, 2, ... devices, then the second, third, ... alone
  bool sameBits = true;        ///< every set gave the same answers

  const ScaleRun& alone(size_t point, uint32_t device) const;
};

/// `step` is called before each of scaleSteps() passes. Throws Error where a query is not answered: a time without its
/// answers says nothing.
ScaleReport measureScale(std::span<const Device> devices, const std::vector<uint32_t>& numbers,
                         const std::vector<ScalePoint>& points, const ScaleSettings& settings,
                         const std::function<void()>& step);
size_t scaleSteps(size_t devices, size_t points, const ScaleSettings& settings);

/// Adds three tables to a report. `runs`: what was gained against the first device alone, efficiency (the share of the
/// speeds of its devices, each alone, added up), and where the devices' time (their number times the time that passed)
/// went, in percent of it that add up to 100: `useful`, at work for as long as each device takes alone for as many
/// queries; `slower`, at work for longer than that; `start`, `gap` and `tail`, idle as in DeviceShare; `scene`, idle
/// while the scene is edited. `encode` is the time encoding over the time with the device. `scale`: a row for each run
/// and device of it, times in milliseconds of a pass over all batches. `stages`: of the last point, milliseconds of a
/// pass with timestamps, summed over devices.
void addTables(const ScaleReport& measured, Json& report);
/// The lines of the chart, of the table `runs`.
Json scaleLines(const Json& runs);
/// The last point's runs in Chrome's trace-event format: a process for each set of devices.
std::string traceOf(const ScaleReport& report);

}  // namespace radar::tools
