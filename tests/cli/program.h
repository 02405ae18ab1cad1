// Runs the built program in a shell.
#pragma once

#include <string>

#include "support/scratch_folder.h"

namespace radar::test {

struct Run {
  int status = 0;
  std::string out, err;
};

/// Runs a command of the shell in `folder`.
Run runCommand(const ScratchFolder& folder, const std::string& command);

/// Runs `cyber-radar arguments` in `folder`. `environment` precedes the command: "NAME=value".
Run runProgram(const ScratchFolder& folder, const std::string& arguments, const std::string& environment = "");

/// The same with radar-lab.
Run runLab(const ScratchFolder& folder, const std::string& arguments, const std::string& environment = "");

/// Runs `cyber-radar arguments`, or what `run` runs, which must end with status 0.
Run succeed(const ScratchFolder& folder, const std::string& arguments, decltype(runProgram)& run = runProgram);

/// Checks that `cyber-radar arguments`, or what `run` runs, ends with status 2, prints nothing but an error that
/// contains `words`, and neither makes, removes nor changes a file in `folder`.
void checkRefused(const ScratchFolder& folder, const std::string& arguments, const std::string& words,
                  decltype(runProgram)& run = runProgram);

}  // namespace radar::test
