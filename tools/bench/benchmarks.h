// The benchmarks of radar_bench: ratios within one run, medians after a warm-up, without validation layers. Each prints
// a table of comma-separated values.
#pragma once

#include <CLI/CLI.hpp>

#include "measure/timing.h"

namespace radar::bench {

using tools::Batch, tools::measure, tools::Repetition, tools::Series, tools::secondsOf;
using Method = tools::Session;

/// Each adds its subcommand, which sets `status` to 1 where methods give different answers.
void addSearch(CLI::App& app, int& status);
void addRecorded(CLI::App& app, int& status);
void addChanges(CLI::App& app, int& status);
void addDeform(CLI::App& app, int& status);

/// What the figures are measured on, as lines that begin with #, and the names of the columns.
void printHead(std::span<const Device> devices);

/// Measures and prints a line for each method.
void printRows(const std::string& workload, const std::vector<Method>& methods, std::span<const Batch> batches,
               const Repetition& repetition, int& status);

}  // namespace radar::bench
