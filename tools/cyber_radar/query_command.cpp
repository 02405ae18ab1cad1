#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "batch/atomic_file.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/query_run.h"
#include "cyber_radar/words.h"
#include "measure/clock.h"
#include "measure/timing.h"
#include "workloads/query_fields.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar query batch.json                       answers to standard output
  cyber-radar query batch.json --out answers.jsonl --mode sampled --resolution 256
  cyber-radar query batch.json --mode contact --device all
  cyber-radar query batch.json --out answers.npy     records that numpy.load reads
  cyber-radar query batch.json --out part-0 --shard 0/4 --resume
  cyber-radar query batch.json --fail-on hit,overlap,undecided --out answers.jsonl
  cyber-radar query batch.json --check               what it asks, without answers
  cyber-radar query batch.json --repeat 9 --stats stats.json --out answers.jsonl

A query file is one JSON object of meshes, scenes and queries (format cyber-radar-queries-1); the answers are JSON
Lines, one per query, in the file's order. cyber-radar workload writes query files to try.)";

struct Options {
  RunOptions run;
  uint32_t repeat = 1;
  bool repeated = false, check = false;
  std::string failOn;
};

struct Times {
  double loadMs = 0, setupMs = 0, sweepMs = 0, writeMs = 0;
};

std::string textOf(uint64_t queries, const Answering& answering, const AnsweringStats& pass, const Times& times) {
  nlohmann::ordered_json stats;
  stats["queries"] = queries;
  stats["batches"] = pass.batches;
  stats["load_ms"] = times.loadMs;
  stats["setup_ms"] = times.setupMs;
  stats["sweep_ms"] = times.sweepMs;
  stats["write_ms"] = times.writeMs;
  stats["host_us_per_query"] = queries == 0 ? 0 : 1e6 * pass.hostSeconds / static_cast<double>(queries);
  stats["stages"] = nlohmann::ordered_json::object();
  for (const StageTime& stage : pass.stages) stats["stages"][stage.name] = stage.ms;
  stats["pairs"] = pass.pairs;
  stats["cpu_pairs"] = pass.cpuPairs;
  stats["cpu_queries"] = pass.cpuQueries;
  const std::span<const Device> devices = answering.answerer().devices();
  stats["device"] = devices.empty() ? nullptr : nlohmann::ordered_json(devices[0].name());
  stats["driver"] = devices.empty() ? nullptr : nlohmann::ordered_json(devices[0].driver());
  for (const PoolDevice& device : answering.answerer().poolDevices()) {
    stats["devices"].push_back(
        {{"name", device.name}, {"driver", device.driver}, {"queries", device.queries}, {"chunks", device.chunks}});
  }
  stats["commit"] = commit();
  return stats.dump(2) + "\n";
}

constexpr std::array kStatuses{Status::hit, Status::clear, Status::overlap, Status::undecided, Status::invalid};

/// "hit,overlap".
std::vector<Status> statusesIn(const std::string& list) {
  std::vector<Status> statuses;
  if (list.empty()) return statuses;
  for (size_t from = 0, comma = 0; comma != list.npos; from = comma + 1) {
    comma = list.find(',', from);
    try {
      statuses.push_back(statusFrom(list.substr(from, comma - from)));
    } catch (const std::invalid_argument& error) {
      throw InputError("--fail-on", "", error.what());
    }
  }
  return statuses;
}

/// One run over a query file, or a part of it.
class Run {
 public:
  Run(const Options& options, const QueryFile& queries, const AnsweringOptions& engine)
      : queries_(queries), answering_(queries.world(), queries.modes(), engine) {
    const Part part = options.run.part(queries, answering_);
    first_ = part.first();
    end_ = part.end();
    if (!options.run.out.empty()) {
      writer_.emplace(options.run.out, part, queries, options.run.resume);
      first_ = writer_->next();
      kept_ = first_ - part.first();
      for (const Status status : kStatuses) statuses_[static_cast<size_t>(status)] = writer_->kept(status);
    }
  }

  uint64_t count() const { return end_ - first_; }
  uint64_t kept() const { return kept_; }
  const Answering& answering() const { return answering_; }
  double setUp() { return setUp(answering_); }
  /// Answers everything and drops the answers.
  AnsweringStats rehearse(const std::string& label) {
    return pass(answering_, label, [](auto...) {});
  }
  /// The same with an engine that measures the stages.
  std::vector<StageTime> stages(AnsweringOptions engine) {
    engine.timestamps = true;
    Answering profile(queries_.world(), queries_.modes(), engine);
    setUp(profile);
    return pass(profile, "measuring stages", [](auto...) {}).stages;
  }
  /// Answers everything and writes the answers as they become complete.
  AnsweringStats write() {
    AnswerRows rows(queries_.world(), writer_ ? writer_->format() : AnswerFormat::lines);
    return pass(answering_, "answering", [&](uint64_t first, auto queries, std::span<const Answer> answers) {
      const std::string text = rows.text(first, queries, answers);
      for (const Answer& answer : answers) ++statuses_[static_cast<size_t>(answer.result.status)];
      if (writer_) {
        writer_->append(text, answers.size());
      } else {
        std::cout << text << std::flush;
        if (!std::cout) throw std::runtime_error("standard output: expected a place to write to, got an error");
      }
    });
  }
  void finish() {
    const double start = now();
    if (writer_) writer_->finish();
    writeMs_ += 1e3 * (now() - start);
  }
  /// Of all answers that were written or kept.
  uint64_t count(Status status) const { return statuses_[static_cast<size_t>(status)]; }
  double readMs() const { return readMs_; }    ///< waited for in the last pass
  double writeMs() const { return writeMs_; }  ///< likewise, and for the end of the file

 private:
  AnsweringStats pass(Answering& answering, const std::string& label, const AnswerSink& sink) {
    answering.resetStats();
    const Waited waited = answerRange(queries_, first_, end_, answering, label, sink);
    readMs_ = 1e3 * waited.reading;
    writeMs_ = 1e3 * waited.writing;
    return answering.stats();
  }
  double setUp(Answering& answering) {
    std::vector<QuerySpec> room;
    return first_ < end_ ? answering.setUp(queries_.read(first_, 1, room)[0].scene) : 0;
  }

  const QueryFile& queries_;
  Answering answering_;
  std::optional<PartWriter> writer_;
  uint64_t first_ = 0, end_ = 0, kept_ = 0;
  double readMs_ = 0, writeMs_ = 0;
  std::array<uint64_t, 5> statuses_{};
};

/// What a query file holds.
std::string countsOf(const QueryFile& queries, AnswerMode command) {
  const Workload& world = queries.world();
  uint64_t triangles = 0, objects = 0, changed = 0;
  for (const MeshData& mesh : world.meshes) triangles += mesh.triangleCount();
  for (uint32_t scene = 0; scene < world.scenes.size(); ++scene) {
    const SceneSpec& spec = world.scenes[scene];
    objects += world.objectCount(scene);
    changed += !spec.masks.empty() || !spec.motions.empty() || !spec.deforms.empty();
  }
  const std::string chains = world.chains.empty() ? "" : counted(world.chains.size(), "chain") + ", ";
  std::map<AnswerMode, uint64_t> modes;
  for (const auto& [mode, count] : queries.modes().modes) modes[mode.value_or(command)] += count;
  std::string text = counted(world.meshes.size(), "mesh", "meshes") + " of " + counted(triangles, "triangle") + ", " +
                     chains + counted(world.scenes.size(), "scene") + " of " + counted(objects, "object") + " (" +
                     std::to_string(changed) + " with masks, motions or deforms), " +
                     counted(queries.count(), "query", "queries");
  const char* separator = ": ";
  for (const auto& [mode, count] : modes) {
    text += std::exchange(separator, ", ") + std::to_string(count) + " " + nameOf(mode);
  }
  return text;
}

// The exit status; says on standard error what it is for.
int judge(const Run& run, const std::vector<Status>& failing) {
  std::string found;
  for (const Status status : failing) {
    if (run.count(status) == 0) continue;
    found += (found.empty() ? "" : ", ") + std::to_string(run.count(status)) + " " + nameOf(status);
  }
  if (!found.empty()) std::cerr << "cyber-radar: --fail-on: expected none of these, got " << found << "\n";
  if (run.count(Status::invalid) > 0) return kStatusSomeInvalid;
  return found.empty() ? 0 : kStatusNotAsWanted;
}

void check(const Options& options, const QueryFile& queries, const AnsweringOptions& engine) {
  options.run.checkFormat(queries);
  Answering answering(queries.world(), queries.modes(), engine);
  std::vector<QuerySpec> room;
  constexpr uint64_t kEach = 16'384;
  for (uint64_t first = 0; first < queries.count(); first += kEach) {
    placed(queries, first,
           [&] { answering.check(queries.read(first, std::min(kEach, queries.count() - first), room)); });
  }
  std::cout << options.run.file << ": " << countsOf(queries, engine.mode) << "\n";
}

int query(const Options& options) {
  const std::vector<Status> failing = statusesIn(options.failOn);
  AnsweringOptions engine = options.run.engine.checked();
  options.run.check();

  const double start = now();
  std::vector<std::string> warnings;
  const QueryFile queries(options.run.file, warnings, options.run.outputs());
  Times times;
  times.loadMs = 1e3 * (now() - start);
  printWarnings(warnings);
  if (options.check) {
    check(options, queries, engine);
    return 0;
  }

  engine.timestamps = !options.run.stats.empty() && !options.repeated;
  Run run(options, queries, engine);
  times.setupMs = run.setUp();
  if (options.repeated) {
    run.rehearse("warming up");
    run.setUp();
  }
  std::vector<double> sweepTimes;
  for (uint32_t i = 1; i < options.repeat; ++i) {
    sweepTimes.push_back(run.rehearse("answering").ms);
    run.setUp();
  }
  const double begun = now();
  AnsweringStats pass = run.write();
  sweepTimes.push_back(pass.ms);
  times.sweepMs = median(sweepTimes);
  times.loadMs += run.readMs();
  run.finish();
  const double seconds = now() - begun;
  times.writeMs = run.writeMs();
  if (!options.run.stats.empty()) {
    // A separate pass measures the stages, since timestamps slow the others.
    if (options.repeated) pass.stages = run.stages(engine);
    writeAtomically(options.run.stats, textOf(run.count(), run.answering(), pass, times));
  }
  if (options.run.engine.resolution == "auto") {
    const std::string chosen = resolutionsInWords(pass);
    if (!chosen.empty()) std::cerr << "cyber-radar: " << chosen << " (chosen per sensor)\n";
  }
  for (const PoolDevice& device : run.answering().answerer().poolDevices()) {
    if (!device.retired.empty()) printWarnings({device.name + " was given up: " + device.retired});
  }
  sayDone("cyber-radar", {run.count(), run.kept(), seconds, begun - start}, statusesInWords(pass));
  return judge(run, failing);
}

}  // namespace

void addQueryCommand(Program& program) {
  Command command = program.add("query", "Answers a query file: many sweeps, many scenes, in batches", kExamples);
  auto options = std::make_shared<Options>();
  options->run.addTo(command, "times and counts");
  const Option repeat = command
                            .option("--repeat", &options->repeat,
                                    "Answers N times, after one warm-up, and takes the median time; with --stats once "
                                    "more, for the times of the stages")
                            .value("N")
                            .within(1, 1'000'000);
  command.option("--check", &options->check, "Reads and checks everything, says what there is, and answers nothing");
  command
      .option("--fail-on", &options->failOn,
              "Ends with exit status 1 if an answer has one of these statuses: hit, clear, overlap, undecided")
      .value("STATUS,...");
  command.run([=] {
    options->repeated = repeat.given();
    return query(*options);
  });
}

void addFieldsCommand(Program& program) {
  program.add("fields", "Prints what a query may ask for, and what an answer says, as tables in Markdown").run([] {
    std::cout << queryFieldTable() << "\n" << answerFieldTable();
    return 0;
  });
}

}  // namespace radar::tools
