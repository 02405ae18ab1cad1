// The commands of the program, each in its own file. A command's callback throws on bad input; `status` is the exit
// status of one that ran.
#pragma once

#include <CLI/CLI.hpp>

#include "cyber_radar/exit_status.h"

namespace radar::tools {

void addSweepCommand(CLI::App& app, int& status);
void addQueryCommand(CLI::App& app, int& status);
void addScopesCommand(CLI::App& app);
void addDevicesCommand(CLI::App& app, int& status);
void addDemoCommand(CLI::App& app, int& status);
void addScaleCommand(CLI::App& app, int& status);
void addSelftestCommand(CLI::App& app, int& status);
void addStabilityCommand(CLI::App& app, int& status);
void addChartCommand(CLI::App& app);
void addCompareCommand(CLI::App& app, int& status);
void addMergeCommand(CLI::App& app, int& status);
void addViewCommand(CLI::App& app, int& status);
void addWorkloadCommand(CLI::App& app);
/// `completion` and `man`, which describe all commands of `app`; it must outlive the parsing.
void addDescribeCommands(CLI::App& app);

}  // namespace radar::tools
