#include <iostream>
#include <stdexcept>

#include "cyber_radar/command_line.h"
#include "cyber_radar/commands.h"
#include "radar/radar.h"

namespace {

constexpr const char* kAbout =
    "Cyber Radar: how far can a shape move along a direction before its surface first touches anything?";

constexpr const char* kExamples = R"(Try:
  cyber-radar demo                          teapots among boxes: a table, and pictures in a folder
  cyber-radar sweep hall.glb robot.ply --direction 1 0 0 --distance 5
                                            one sweep, answered in words
  cyber-radar query batch.json --out answers.jsonl
                                            many sweeps from a file, one JSON line each
  cyber-radar merge PART... --out answers.jsonl
                                            joins the parts that query --shard answered
  cyber-radar compare A B --within 1e-9     whether two answer files agree
  cyber-radar workload table1 --out DIR     a batch to try that with
  cyber-radar scale --quick --out DIR       what several devices gain, and what limits them
  cyber-radar stability --out DIR           every tier against the exact answer, where methods fail
  cyber-radar chart --quick --out DIR       accuracy against speed, mode by mode, in charts
  cyber-radar selftest --out DIR            every device tried: arithmetic, answers, speed
  cyber-radar devices                       what could compute here, and what speaks against it

Each command explains itself: cyber-radar sweep --help
Exit status: 0; 1 if some query could not be answered, or answers are not as --expect, --fail-on or compare want them;
2 for bad input or no usable device.)";

constexpr const char* kNoDeviceHint =
    "To compute without a GPU, install Mesa's software device: apt install mesa-vulkan-drivers\n"
    "--mode reference needs no Vulkan device at all.";

/// A full disk shows only now: what was printed stayed in memory.
void finishOutput() {
  if (!std::cout.flush()) throw std::runtime_error("standard output: expected a place to write to, got an error");
}

int fail(const std::string& message) {
  std::cout.flush();
  std::cerr << "cyber-radar: " << message << "\n";
  return radar::tools::kStatusBadInput;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{kAbout, "cyber-radar"};
  app.footer(kExamples);
  app.require_subcommand(1);
  radar::tools::addBasics(app);
  int status = 0;
  radar::tools::addSweepCommand(app, status);
  radar::tools::addViewCommand(app, status);
  radar::tools::addQueryCommand(app, status);
  radar::tools::addMergeCommand(app, status);
  radar::tools::addCompareCommand(app, status);
  radar::tools::addScopesCommand(app);
  radar::tools::addDevicesCommand(app, status);
  radar::tools::addDemoCommand(app, status);
  radar::tools::addScaleCommand(app, status);
  radar::tools::addSelftestCommand(app, status);
  radar::tools::addStabilityCommand(app, status);
  radar::tools::addChartCommand(app);
  radar::tools::addWorkloadCommand(app);
  radar::tools::addDescribeCommands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    status = app.exit(error) == 0 ? 0 : radar::tools::kStatusBadInput;
  }
  finishOutput();
  return status;
} catch (const radar::Error& error) {
  std::string message = error.what();
  for (const std::string& reason : error.reasons) message += "\n  " + reason;
  // What a person can do about it.
  if (error.kind == radar::Error::Kind::device) message.append("\n").append(kNoDeviceHint);
  return fail(message);
} catch (const std::exception& error) {
  return fail(error.what());
}
