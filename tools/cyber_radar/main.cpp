#include "cyber_radar/commands.h"

namespace {

constexpr const char* kAbout =
    "Cyber Radar: how far can a shape move along a direction before its surface first touches anything?";

constexpr const char* kExamples = R"(Try:
  cyber-radar demo                          teapots among boxes: a table, and a page that shows each flight
  cyber-radar sweep hall.glb robot.ply --direction 1 0 0 --distance 5
                                            one sweep, answered in words
  cyber-radar info hall.glb                 what a mesh file holds: nodes, sizes, closed or open
  cyber-radar query batch.json --out answers.jsonl
                                            many sweeps from a file, one JSON line each
  cyber-radar stream cell.json              queries from standard input, each answered as it comes
  cyber-radar merge PART... --out answers.jsonl
                                            joins the parts that query --shard answered
  cyber-radar compare A B --within 1e-9     whether two answer files agree
  cyber-radar view batch.json --out FILE    a page that shows scene, flights and answers
  cyber-radar workload table1 --out DIR     a batch to try that with
  cyber-radar scale --quick --out DIR       what several devices gain, and what limits them
  cyber-radar selftest --out DIR            every device tried: arithmetic, answers, speed
  cyber-radar devices                       what could compute here, and what speaks against it

Each command explains itself: cyber-radar sweep --help
Exit status: 0; 1 if some query could not be answered, answers are not as --expect, --fail-on or compare want them, or
selftest finds something wrong; 2 for bad input or no usable device.)";

constexpr const char* kNoDeviceHint =
    "\nTo compute without a GPU, install Mesa's software device: apt install mesa-vulkan-drivers\n"
    "--mode reference needs no Vulkan device at all.";

}  // namespace

int main(int argc, char** argv) {
  using namespace radar::tools;
  Program program("cyber-radar", kAbout, kExamples, kNoDeviceHint);
  addSweepCommand(program);
  addViewCommand(program);
  addInfoCommand(program);
  addQueryCommand(program);
  addStreamCommand(program);
  addFieldsCommand(program);
  addMergeCommand(program);
  addCompareCommand(program);
  addScopesCommand(program);
  addDevicesCommand(program);
  addDemoCommand(program);
  addScaleCommand(program);
  addSelftestCommand(program);
  addWorkloadCommand(program);
  program.addDescriptions();
  return program.main(argc, argv);
}
