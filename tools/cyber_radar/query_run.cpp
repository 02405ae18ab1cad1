#include "cyber_radar/query_run.h"

#include <algorithm>

#include "bench/clock.h"
#include "commit/commit.h"

namespace radar::tools {

void RunOptions::addTo(CLI::App& command) {
  command.add_option("FILE.json", file, "Query file; - for standard input")->required();
  command
      .add_option("--out", out,
                  "Where the answers go: lines of JSON, or to a file .npy records for numpy; else to standard output")
      ->type_name("FILE");
  command
      .add_option("--shard", shard,
                  "Answers part I of N equal parts of the queries, I from 0; cyber-radar merge joins the parts")
      ->type_name("I/N");
  command.add_flag("--resume", resume, "Finishes what an interrupted run with the same options left in FILE.partial");
  engine.severalDevices = true;
  engine.addTo(command);
}

void RunOptions::check() const {
  if (!out.empty()) requireFolderOf("--out", out);
  if (!shard.empty() && out.empty()) throw InputError("--shard", "", "expected --out beside it, got none");
  if (resume && out.empty()) throw InputError("--resume", "", "expected --out beside it, got none");
  if (!shard.empty()) shardFrom(shard);
}

Part RunOptions::part(const QueryFile& queries, std::span<const Device> devices) const {
  Part part;
  part.format = answerFormatOf(out);
  if (part.format == AnswerFormat::records && queries.modes().listed) {
    throw InputError("--out", out,
                     "expected another file than .npy, as answers with \"hits\" or \"skip_overlapping\" have lists "
                     "(query \"" +
                         *queries.modes().listed + "\")");
  }
  part.queries = queries.count();
  if (!shard.empty()) part.shard = shardFrom(shard);
  part.fingerprint = queries.fingerprint();
  part.mode = engine.mode;
  part.resolution = engine.resolution;
  part.program = commit();
  if (queries.modes().asks(AnswerMode::sampled, modeFrom(engine.mode))) part.device = namesOf(devices);
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

double answerRange(const QueryFile& queries, uint64_t first, uint64_t end, Answering& answering,
                   const std::string& label, const AnswerSink& sink) {
  // At first as many as the engine submits at once. What a chunk holds is lost if the run is killed.
  constexpr double kSeconds = 2;
  uint64_t chunk = 16'384;
  Progress progress(label, end - first);
  std::vector<QuerySpec> room;
  double reading = 0;
  while (first < end) {
    const double beforeReading = bench::now();
    const std::span<const QuerySpec> asked = queries.read(first, std::min(chunk, end - first), room);
    const double start = bench::now();
    reading += start - beforeReading;
    const std::vector<Answer> answers = answering.run(asked, progress);
    const double rate = static_cast<double>(asked.size()) / std::max(bench::now() - start, 1e-6);
    sink(first, asked, answers);
    first += asked.size();
    chunk = static_cast<uint64_t>(std::clamp(kSeconds * rate, 256.0, 262'144.0));
  }
  return reading;
}

}  // namespace radar::tools
