// cyber-radar-mpi: answers a query file on many machines.
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "batch/atomic_file.h"
#include "command/exit_status.h"
#include "commit/commit.h"
#include "cyber_radar/query_run.h"
#include "measure/clock.h"
#include "mpi/coordinator.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  mpirun -np 4 --map-by ppr:1:node --bind-to none cyber-radar-mpi query batch.json --out answers.jsonl
  srun --ntasks-per-node=1 cyber-radar-mpi query batch.json --out answers.npy --resume

One rank a node answers on the node's devices; ranks that share a node share its devices and cores. All ranks read the
file, on a disk that they share; rank 0 writes the answers, with the bytes that cyber-radar query writes.)";

// What a signal's handler prints.
std::string farewell;

void sayFarewell(int signal) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, farewell.data(), farewell.size());
  _exit(128 + signal);
}

std::string resumeHint(const std::string& out) {
  return "cyber-radar-mpi: the run ended early; " + out + ".partial has the answers so far, and --resume finishes it\n";
}

// Ranks of one machine share its devices, and its cores if the number of threads is not chosen.
void takeShare(AnsweringOptions& options, const EngineOptions& given, const MpiSession& session, bool needsDevice) {
  const auto local = static_cast<size_t>(session.localRank()), count = static_cast<size_t>(session.localCount());
  if (options.threads == 0) {
    options.threads = std::max(1u, std::thread::hardware_concurrency() / static_cast<uint32_t>(count));
  }
  if (!needsDevice) return;
  std::vector<uint32_t> all = !given.device ? std::vector<uint32_t>() : devicesFrom(*given.device);
  if (all.empty()) {
    const std::vector<DeviceReport> reports = listDevices();
    for (uint32_t i = 0; i < reports.size(); ++i) {
      if (reports[i].usable()) all.push_back(i);
    }
  }
  std::vector<uint32_t> own;
  for (size_t i = local; i < all.size(); i += count) own.push_back(all[i]);
  if (own.empty() && !all.empty()) own.push_back(all[local % all.size()]);
  options.pool.reset();
  options.device = own.size() == 1 ? own[0] : kNone;
  if (own.size() > 1) options.pool = own;
}

/// Who answers.
struct RankReport {
  std::string host = hostName(), devices, fingerprint;
  std::string failure;  ///< why the rank cannot answer
};

// On rank 0, what all ranks report.
std::vector<RankReport> reportsOf(const RankReport& own) {
  std::vector<RankReport> all;
  for (std::string RankReport::*const member :
       {&RankReport::host, &RankReport::devices, &RankReport::fingerprint, &RankReport::failure}) {
    std::vector<std::string> texts = gather(own.*member);
    all.resize(texts.size());
    for (size_t rank = 0; rank < texts.size(); ++rank) all[rank].*member = std::move(texts[rank]);
  }
  return all;
}

std::string nameOf(size_t rank, const RankReport& report) {
  return "rank " + std::to_string(rank) + " on " + report.host;
}

// Says why ranks cannot answer, each reason once. Returns whether all can.
bool allCanAnswer(const std::vector<RankReport>& reports, bool sampled) {
  std::map<std::string, std::vector<std::string>> failures;
  for (size_t rank = 0; rank < reports.size(); ++rank) {
    const RankReport& report = reports[rank];
    std::string problem = report.failure;
    const auto require = [&](const char* what, const std::string& found, const std::string& wanted) {
      if (!problem.empty() || !reports[0].failure.empty() || found == wanted) return;
      problem = std::string(what) + " of rank 0, \"" + wanted + "\", got \"" + found + "\"";
    };
    require("expected the query file", report.fingerprint, reports[0].fingerprint);
    if (sampled) require("in mode sampled, expected the device", report.devices, reports[0].devices);
    if (!problem.empty()) failures[problem].push_back(nameOf(rank, report));
  }
  for (const auto& [problem, names] : failures) {
    std::cerr << "cyber-radar-mpi: ";
    if (names.size() < reports.size()) {
      for (const std::string& name : names) std::cerr << name << ": ";
    }
    std::cerr << problem << "\n";
  }
  return failures.empty();
}

std::string statsOf(const std::vector<RankReport>& reports, const Coordinator& coordinator, double loadMs,
                    double setupMs, double sweepMs) {
  nlohmann::ordered_json stats;
  uint64_t queries = 0;
  for (const Coordinator::Work& work : coordinator.work()) queries += work.queries;
  stats["queries"] = queries;
  stats["load_ms"] = loadMs;
  stats["setup_ms"] = setupMs;
  stats["sweep_ms"] = sweepMs;
  for (size_t rank = 0; rank < reports.size(); ++rank) {
    const Coordinator::Work& work = coordinator.work()[rank];
    stats["ranks"].push_back({{"host", reports[rank].host},
                              {"devices", reports[rank].devices},
                              {"queries", work.queries},
                              {"chunks", work.chunks},
                              {"busy_ms", 1e3 * work.seconds}});
  }
  stats["commit"] = commit();
  return stats.dump(2) + "\n";
}

/// One rank's part in a run.
class Rank {
 public:
  Rank(const RunOptions& options, const MpiSession& session) : options_(options), session_(session) {}

  int run() {
    reports_ = reportsOf(prepare());
    if (!broadcast(isFirst() && opens())) return kStatusBadInput;
    ChunkAnswers answers(*queries_, *answering_, answerFormatOf(options_.out));
    if (isFirst()) return coordinate(answers);
    answers.serve();
    return 0;
  }

 private:
  bool isFirst() const { return session_.rank() == 0; }

  RankReport prepare() {
    RankReport report;
    try {
      const double start = now();
      std::vector<std::string> warnings;
      queries_.emplace(options_.file, warnings, isFirst() ? options_.outputs() : Outputs());
      if (isFirst()) printWarnings(warnings);
      report.fingerprint = queries_->fingerprint();
      loadMs_ = 1e3 * (now() - start);
      AnsweringOptions engine = options_.engine.checked();
      const bool needsDevice = queries_->modes().asks(AnswerMode::sampled, engine.mode) ||
                               queries_->modes().asks(AnswerMode::contact, engine.mode);
      takeShare(engine, options_.engine, session_, needsDevice);
      answering_.emplace(queries_->world(), queries_->modes(), engine);
      if (!queries_->world().scenes.empty()) answering_->setUp(0);
      report.devices = namesOf(answering_->answerer().devices());
      setupMs_ = 1e3 * (now() - start) - loadMs_;
    } catch (const Error& error) {
      report.failure = error.what();
      for (const std::string& reason : error.reasons) report.failure += "\n  " + reason;
    } catch (const std::exception& error) {
      report.failure = error.what();
    }
    return report;
  }

  // Rank 0: all ranks can answer, and the answers have a place.
  bool opens() {
    try {
      const bool sampled = queries_ && queries_->modes().asks(AnswerMode::sampled, options_.engine.checked().mode);
      if (!allCanAnswer(reports_, sampled)) return false;
      const Part part = options_.part(*queries_, *answering_);
      first_ = part.first();
      end_ = part.end();
      writer_.emplace(options_.out, part, *queries_, options_.resume);
      return true;
    } catch (const std::exception& error) {
      std::cerr << "cyber-radar-mpi: " << error.what() << "\n";
      return false;
    }
  }

  int coordinate(ChunkAnswers& answers) {
    // mpirun ends all ranks with this signal when one was killed.
    farewell = resumeHint(options_.out);
    std::signal(SIGTERM, sayFarewell);
    try {
      const double start = now();
      const uint64_t next = writer_->next();
      Coordinator coordinator(*writer_, end_, static_cast<size_t>(session_.count()), answers);
      coordinator.run();
      const double sweepMs = 1e3 * (now() - start);
      writer_->finish();
      if (!options_.stats.empty()) {
        writeAtomically(options_.stats, statsOf(reports_, coordinator, loadMs_, setupMs_, sweepMs));
      }
      sayDone("cyber-radar-mpi", {end_ - next, next - first_, now() - start, 1e-3 * (loadMs_ + setupMs_)},
              " on " + counted(reports_.size(), "rank"));
      return coordinator.someInvalid() ? kStatusSomeInvalid : 0;
    } catch (const RankFailure& failure) {
      std::cerr << "cyber-radar-mpi: " << nameOf(failure.rank(), reports_[failure.rank()]) << ": " << failure.what()
                << "\n";
    } catch (const std::exception& error) {
      std::cerr << "cyber-radar-mpi: " << error.what() << "\n";
    }
    writer_.reset();
    if (std::filesystem::exists(options_.out + ".partial")) std::cerr << farewell << std::flush;
    MPI_Abort(MPI_COMM_WORLD, kStatusBadInput);
    return kStatusBadInput;
  }

  const RunOptions& options_;
  const MpiSession& session_;
  std::optional<QueryFile> queries_;
  std::optional<Answering> answering_;
  std::vector<RankReport> reports_;
  std::optional<PartWriter> writer_;
  uint64_t first_ = 0, end_ = 0;
  double loadMs_ = 0, setupMs_ = 0;
};

int run(int argc, char** argv, const MpiSession& session) {
  Program program("cyber-radar-mpi", "Cyber Radar on many machines: answers a query file with the ranks of an MPI run");
  Command command = program.add("query", "Answers a query file", kExamples);
  RunOptions options;
  options.addTo(command, "times, and what each rank did,").required();
  // All ranks read the same options, and one speaks.
  try {
    if (const std::optional<int> status = program.parse(argc, argv, session.rank() > 0)) return *status;
    options.engine.checked();
    options.check();
    if (options.file == "-" || isStream(options.file)) {
      throw InputError("FILE.json", options.file, "expected a file that every rank can read, got a stream");
    }
  } catch (const std::exception& error) {
    if (session.rank() == 0) std::cerr << "cyber-radar-mpi: " << error.what() << "\n";
    return kStatusBadInput;
  }
  return Rank(options, session).run();
}

}  // namespace

}  // namespace radar::tools

int main(int argc, char** argv) {
  const radar::tools::MpiSession session(argc, argv);
  try {
    return radar::tools::run(argc, argv, session);
  } catch (const std::exception& error) {
    // The other ranks wait for this one: they are ended, too.
    std::cerr << "cyber-radar-mpi: rank " << session.rank() << " on " << radar::tools::hostName() << ": "
              << error.what() << "\n";
    MPI_Abort(MPI_COMM_WORLD, radar::tools::kStatusBadInput);
  }
}
