#pragma once

#include <string>

#include "command/command.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Where a command writes a workload to: --out, --binary.
struct WorkloadOutput {
  std::string folder;
  bool binary = false;

  void addTo(Command& command);
  /// Writes the query file and what it names, and says so on standard output. Throws InputError.
  void write(const Workload& workload) const;
};

}  // namespace radar::tools
