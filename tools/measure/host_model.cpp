#include "measure/host_model.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "radar/error.h"

namespace radar::tools {

namespace {

constexpr std::array kDevices{MeasuredDevice{"boxes", 1'024, 0.8}, MeasuredDevice{"boxes", 16'384, 0.055},
                              MeasuredDevice{"boxes", 131'072, 0.056}, MeasuredDevice{"boxes", 1'048'576, 0.055},
                              MeasuredDevice{"teapots", 65'536, 0.092}};

// The row of one thread with the largest batch up to `most`.
const Json& rowFor(const Json& rows, std::string_view workload, uint32_t most) {
  const Json* best = nullptr;
  for (const Json& row : rows) {
    if (row["workload"] != workload || row["threads"] != 1 || row["batch"] > most) continue;
    if (best == nullptr || row["batch"] > (*best)["batch"]) best = &row;
  }
  if (best == nullptr) {
    throw Error("expected a measured batch of " + std::string(workload) + " of at most " + std::to_string(most) +
                " queries, on one thread, got none");
  }
  return *best;
}

double inParallel(const Json& row) {
  return row["check_us"].get<double>() + row["submit_us"].get<double>() + row["decode_us"].get<double>();
}

}  // namespace

std::span<const MeasuredDevice> measuredDevices() {
  return kDevices;
}

Json modelRows(const Json& hostRows) {
  Json rows = Json::array();
  for (const MeasuredDevice& device : kDevices) {
    const Json& row = rowFor(hostRows, device.workload, device.batch);
    const auto measured = row["batch"].get<double>();
    const double recording = inParallel(rowFor(hostRows, device.workload, 1));  // of a call
    // Stages are told by the clock on the wall, the host's part by its thread's: beside other work they may exceed it.
    const double all = row["host_us"], stages = std::min(inParallel(row), all);
    const double parallel = std::max(0.0, stages - recording / measured);
    const double record = recording / device.batch;
    const double serial = all - stages + record;
    const double host = serial + parallel / kModelThreads;
    const double expected = std::max(device.us, host);
    rows.push_back({{"workload", device.workload},
                    {"batch", device.batch},
                    {"device_us", device.us},
                    {"host_batch", row["batch"]},
                    {"record_us", record},
                    {"serial_us", serial},
                    {"parallel_us", parallel},
                    {"host_us", host},
                    {"expected_us", expected},
                    {"expected_per_s", 1e6 / expected},
                    {"sum_per_s", 1e6 / (device.us + host)},
                    {"bound_by", device.us > host ? "device" : "host"}});
  }
  return rows;
}

std::string modelAssumptions() {
  return print(
      "A model, not a measurement. device_us: measured with that batch on an\n%s.\n"
      "host_us = serial_us + parallel_us / %u, measured on this machine's processor with one thread, in batches of\n"
      "host_batch: parallel_us is what check, submit and decode take but for record_us, which a call takes once\n"
      "whatever its batch; serial_us is the rest, that included. Assumed: %u threads share parallel_us evenly, a "
      "query\n"
      "costs the host the same in each batch from host_batch on, and neither the other machine's processor nor its\n"
      "memory is slower than this one's. expected_us is the greater of device_us and host_us: the host's work hides "
      "behind the\n"
      "device's, or the other way. sum_per_s: if nothing is hidden.\n",
      kMeasuredDevice, kModelThreads, kModelThreads);
}

}  // namespace radar::tools
