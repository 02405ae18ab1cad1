// The built program, run as a person runs it.
#pragma once

#include <string>

#include "support/scratch_folder.h"

namespace radar::test {

struct Run {
  int status = 0;
  std::string out, err;
};

/// Runs `cyber-radar arguments` in a shell, in the folder. `environment` is put in front: "NAME=value".
Run runProgram(const ScratchFolder& folder, const std::string& arguments, const std::string& environment = "");

}  // namespace radar::test
