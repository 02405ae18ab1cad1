// The benchmarks of radar_bench: ratios within one run, medians after a warm-up, without validation layers.
#pragma once

#include <CLI/CLI.hpp>

#include "bench/harness.h"

namespace radar::bench {

/// Each adds its subcommand, which sets `status` to 1 where answers differ.
void addSearch(CLI::App& app, int& status);
void addRecorded(CLI::App& app, int& status);
void addPool(CLI::App& app, int& status);

/// Prints what the figures below it were measured on.
void printOrigin(const Device& device);

/// Median of what the passes took, milliseconds.
double medianMs(const std::vector<Lap>& laps, double Lap::*clock = &Lap::wall);

}  // namespace radar::bench
