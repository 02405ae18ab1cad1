#include <iostream>
#include <nlohmann/json.hpp>

#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "bench/clock.h"
#include "bench/statistics.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar query batch.json                       answers to standard output
  cyber-radar query batch.json --out answers.jsonl --mode sampled --resolution 256
  cyber-radar query batch.json --mode contact --device all
  cyber-radar query batch.json --repeat 9 --stats stats.json --out answers.jsonl

A query file is one JSON object of meshes, scenes and queries (format cyber-radar-queries-1); the answers are JSON
Lines, one per query, in the file's order. cyber-radar workload writes query files to try.)";

struct Options {
  EngineOptions engine;
  std::string file, out, stats;
  uint32_t repeat = 1;
  bool repeated = false;
};

std::string statsOf(const Workload& workload, const Answering& answering, const Answering::Pass& pass, double loadMs,
                    double setupMs, double sweepMs) {
  nlohmann::ordered_json stats;
  stats["queries"] = workload.queries.size();
  stats["batches"] = answering.batchCount();
  stats["load_ms"] = loadMs;
  stats["setup_ms"] = setupMs;
  stats["sweep_ms"] = sweepMs;
  stats["stages"] = nlohmann::ordered_json::object();
  for (const StageTime& stage : pass.stages) stats["stages"][stage.name] = stage.ms;
  stats["pairs"] = pass.pairs;
  stats["cpu_pairs"] = pass.cpuPairs;
  const std::span<const Device> devices = answering.devices();
  stats["device"] = devices.empty() ? nullptr : nlohmann::ordered_json(devices[0].name());
  stats["driver"] = devices.empty() ? nullptr : nlohmann::ordered_json(devices[0].driver());
  for (const PoolDevice& device : answering.poolDevices()) {
    stats["devices"].push_back(
        {{"name", device.name}, {"driver", device.driver}, {"queries", device.queries}, {"chunks", device.chunks}});
  }
  stats["commit"] = commit();
  return stats.dump(2) + "\n";
}

int query(const Options& options) {
  AnsweringOptions engine = options.engine.checked();
  if (!options.out.empty()) requireFolderOf("--out", options.out);
  if (!options.stats.empty()) requireFolderOf("--stats", options.stats);

  const double start = bench::now();
  std::vector<std::string> warnings;
  const Workload workload = readQueryFile(options.file, warnings);
  const double loadMs = 1e3 * (bench::now() - start);
  printWarnings(warnings);

  engine.timestamps = !options.stats.empty() && !options.repeated;
  Answering answering(workload, engine);
  const double setupMs = answering.setUp();
  if (options.repeated) {
    answering.run("warming up");
    answering.setUp();
  }
  Answering::Pass pass = answering.run("answering");
  std::vector<double> times{pass.ms};
  for (uint32_t i = 1; i < options.repeat; ++i) {
    answering.setUp();
    times.push_back(answering.run("answering again").ms);
  }
  if (!options.stats.empty()) {
    if (options.repeated) {
      // A separate pass measures the stages, since timestamps slow the others.
      engine.timestamps = true;
      Answering profile(workload, engine);
      profile.setUp();
      pass.stages = profile.run("measuring stages").stages;
    }
    writeAtomically(options.stats, statsOf(workload, answering, pass, loadMs, setupMs, median(times)));
  }
  const std::string lines = answerLines(workload, pass.answers);
  if (options.out.empty()) {
    std::cout << lines << std::flush;
    if (!std::cout) throw std::runtime_error("standard output: expected a place to write to, got an error");
  } else {
    writeAtomically(options.out, lines);
  }
  if (options.engine.resolution == "auto") {
    const std::string chosen = resolutionsInWords(pass.answers);
    if (!chosen.empty()) std::cerr << "cyber-radar: " << chosen << " (chosen per sensor)\n";
  }
  for (const PoolDevice& device : answering.poolDevices()) {
    if (!device.retired.empty()) printWarnings({device.name + " was given up: " + device.retired});
  }
  return exitStatusOf(pass.answers);
}

}  // namespace

void addQueryCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("query", "Answers a query file: many sweeps, many scenes, in batches");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  command->add_option("FILE.json", options->file, "Query file; - for standard input")->required();
  command->add_option("--out", options->out, "Where the answers go; else to standard output")->type_name("FILE.jsonl");
  options->engine.severalDevices = true;
  options->engine.addTo(*command);
  CLI::Option* repeat =
      command
          ->add_option("--repeat", options->repeat,
                       "Answers N times, after one warm-up, and takes the median time; with --stats once more, for the "
                       "times of the stages")
          ->check(CLI::Range(1u, 1'000'000u))
          ->type_name("N")
          ->capture_default_str();
  command->add_option("--stats", options->stats, "Writes times and counts here, as one JSON object")
      ->type_name("FILE.json");
  command->callback([=, &status] {
    options->repeated = repeat->count() > 0;
    status = query(*options);
  });
}

}  // namespace radar::tools
