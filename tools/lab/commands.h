// The commands of radar-lab, each in its own file. A command throws on bad input.
#pragma once

#include "command/command.h"

namespace radar::tools {

void addChartCommand(Program& program);
void addStabilityCommand(Program& program);
void addTuneCommand(Program& program);
void addHostCommand(Program& program);
void addHardCasesCommand(Program& program);

}  // namespace radar::tools
