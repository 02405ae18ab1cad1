#include "batch/merge.h"

#include <memory>
#include "batch/outputs.h"
#include "cyber_radar/commands.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  for i in 0 1 2 3; do cyber-radar query batch.json --shard $i/4 --out part-$i --resume; done
  cyber-radar merge part-0 part-1 part-2 part-3 --out answers.jsonl)";

}  // namespace

void addMergeCommand(Program& program) {
  Command command =
      program.add("merge", "Joins the answers of cyber-radar query --shard to one answer file", kExamples);
  struct Options {
    std::vector<std::string> files;
    std::string out;
  };
  auto options = std::make_shared<Options>();
  command.option("PART", &options->files, "The answer files of all shards, in any order").required();
  command.option("--out", &options->out, "Where the answers go").required().value("FILE");
  command.run([options] {
    Outputs outputs;
    outputs.add("--out", options->out);
    for (const std::string& part : options->files) outputs.requireNone(part);
    return mergeShards(options->files, options->out) ? 0 : kStatusSomeInvalid;
  });
}

}  // namespace radar::tools
