// The commands of the program, each in its own file. A command throws on bad input.
#pragma once

#include "command/command.h"
#include "command/exit_status.h"

namespace radar::tools {

void addSweepCommand(Program& program);
void addInfoCommand(Program& program);
void addQueryCommand(Program& program);
void addStreamCommand(Program& program);
void addFieldsCommand(Program& program);
void addMergeCommand(Program& program);
void addCompareCommand(Program& program);
void addViewCommand(Program& program);
void addScopesCommand(Program& program);
void addDevicesCommand(Program& program);
void addDemoCommand(Program& program);
void addScaleCommand(Program& program);
void addSelftestCommand(Program& program);
void addWorkloadCommand(Program& program);

}  // namespace radar::tools
