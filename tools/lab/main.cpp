#include "lab/commands.h"

namespace {

constexpr const char* kAbout = "Measures Cyber Radar itself, and holds it against exact answers and other libraries.";

constexpr const char* kExamples = R"(Try:
  radar-lab chart --extent quick --out DIR  accuracy against speed, mode by mode, in charts
  radar-lab stability --out DIR             every tier against the exact answer, where methods fail
  radar-lab host                            what a call costs the host, beside the device
  radar-lab tune                            what the search is fastest with on a device
  radar-lab hard-cases --family thin --out DIR
                                            such cases as a query file

Exit status: 0; 1 if stability finds a promise broken; 2 for bad input or no usable device.)";

}  // namespace

int main(int argc, char** argv) {
  using namespace radar::tools;
  Program program("radar-lab", kAbout, kExamples);
  addChartCommand(program);
  addStabilityCommand(program);
  addHostCommand(program);
  addTuneCommand(program);
  addHardCasesCommand(program);
  return program.main(argc, argv);
}
