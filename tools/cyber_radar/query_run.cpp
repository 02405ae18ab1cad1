#include "cyber_radar/query_run.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <iostream>

#include "answer/chunk_size.h"
#include "commit/commit.h"
#include "measure/clock.h"

namespace radar::tools {

Option RunOptions::addTo(Command& command, const std::string& about) {
  command.option("FILE.json", &file, "Query file; - for standard input").required();
  const Option answers =
      command
          .option(
              "--out", &out,
              "Where the answers go: lines of JSON; to a file .npy, records for numpy; to a file .csv, a table; else "
              "to standard output")
          .value("FILE");
  command
      .option("--shard", &shard,
              "Answers part I of N equal parts of the queries, I from 0; cyber-radar merge joins the parts")
      .value("I/N");
  command.option("--resume", &resume, "Finishes what an interrupted run with the same options left in FILE.partial");
  command.option("--stats", &stats, "Writes " + about + " here, as one JSON object").value("FILE.json");
  engine.severalDevices = true;
  engine.addTo(command);
  return answers;
}

void RunOptions::check() const {
  if (!shard.empty() && out.empty()) throw InputError("--shard", "", "expected --out beside it, got none");
  if (resume && out.empty()) throw InputError("--resume", "", "expected --out beside it, got none");
  if (!shard.empty()) shardFrom(shard);
}

Outputs RunOptions::outputs() const {
  Outputs outputs;
  if (!out.empty()) outputs.add("--out", out);
  if (!out.empty() && !isStream(out)) outputs.add("--out", out + ".partial");
  if (!stats.empty()) outputs.add("--stats", stats);
  if (resume && isStream(out)) throw InputError("--resume", out, "expected a file, got a device or a pipe");
  return outputs;
}

void RunOptions::checkFormat(const QueryFile& queries) const {
  requireRoom(out, queries.modes());
}

Part RunOptions::part(const QueryFile& queries, Answering& answering) const {
  checkFormat(queries);
  Part part;
  part.format = answerFormatOf(out);
  part.queries = queries.count();
  if (!shard.empty()) part.shard = shardFrom(shard);
  part.fingerprint = queries.fingerprint();
  part.mode = engine.mode;
  part.resolution = engine.resolution;
  part.program = commit();
  if (queries.modes().asks(AnswerMode::sampled, modeFrom(engine.mode))) {
    answering.open();
    part.device = namesOf(answering.answerer().devices());
  }
  return part;
}

std::string namesOf(std::span<const Device> devices) {
  std::string names;
  for (const Device& device : devices) {
    const std::string name = device.name() + ", " + device.driver();
    if (names.find(name) == names.npos) names += (names.empty() ? "" : "; ") + name;
  }
  return names;
}

void sayDone(const char* program, const Done& done, const std::string& more) {
  const double rate = static_cast<double>(done.queries) / std::max(done.seconds, 1e-6);
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(rate, 1.0))) - 2));  // three digits
  std::cerr << program << ": answered " << counted(done.queries, "query", "queries") << " in " << inTime(done.seconds);
  if (done.queries > 0) std::cerr << " (" << std::llround(unit * std::round(rate / unit)) << " per second)";
  std::cerr << more << "; reading and preparing took " << inTime(done.preparation);
  if (done.kept > 0) std::cerr << "; " << done.kept << " had been answered before";
  std::cerr << "\n";
}

namespace {

/// Consecutive queries, and their answers once there are any.
struct Chunk {
  uint64_t first = 0;
  std::vector<QuerySpec> room{};
  std::span<const QuerySpec> queries{};
  std::vector<Answer> answers{};
};

}  // namespace

Waited answerRange(const QueryFile& queries, uint64_t first, uint64_t end, Answering& answering,
                   const std::string& label, const AnswerSink& sink) {
  // At first as many as the engine submits at once. What two chunks hold is lost if the run is killed.
  ChunkSize size{.seconds = 2, .next = 16'384, .least = 256, .most = 262'144};
  Progress progress(label, end - first);
  const auto read = [&](Chunk& chunk) {
    chunk.first = first;
    chunk.queries = queries.read(first, std::min(size.next, end - first), chunk.room);
    first += chunk.queries.size();
  };
  const auto write = [&](const Chunk& chunk) {
    if (!chunk.answers.empty()) sink(chunk.first, chunk.queries, chunk.answers);
  };
  Waited waited;
  const double begun = now();
  Chunk answered, current, next;
  read(current);
  waited.reading = now() - begun;
  while (!current.queries.empty()) {
    std::future<void> beside = std::async(std::launch::async, [&] {
      write(answered);
      read(next);
    });
    const double start = now();
    current.answers = placed(queries, current.first, [&] { return answering.run(current.queries, progress); });
    const double done = now();
    beside.get();
    waited.writing += now() - done;
    size.answered(current.queries.size(), done - start);
    std::swap(answered, current);
    std::swap(current, next);
  }
  const double last = now();
  write(answered);
  waited.writing += now() - last;
  return waited;
}

}  // namespace radar::tools
