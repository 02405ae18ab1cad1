#include "cyber_radar/workload_output.h"
#include "lab/commands.h"
#include "workloads/turning_families.h"

namespace radar::tools {

void addHardCasesCommand(Program& program) {
  struct Options {
    std::string family;
    uint64_t seed = 1, first = 0;
    uint32_t cases = 1;
    WorkloadOutput output;
  };
  Command command =
      program.add("hard-cases", "Writes cases of a family in which queries are known to fail, in one scene");
  auto options = std::make_shared<Options>();
  options->output.addTo(command);
  std::vector<std::string> names = hardFamilyNames();
  for (const std::string& turning : namesOf(turningFamilies())) names.push_back(turning);
  command.option("--family", &options->family, "Which").required().oneOf(names);
  command.option("--seed", &options->seed, "Another seed, other cases").value("N");
  command.option("--first", &options->first, "Number of the first case").value("N");
  command.option("--cases", &options->cases, "How many").value("N").within(1, 100'000'000);
  command.run([options] {
    options->output.write(
        hardScene(hardFamily(options->family), options->seed, options->first, options->cases, Company::mixed));
    return 0;
  });
}

}  // namespace radar::tools
