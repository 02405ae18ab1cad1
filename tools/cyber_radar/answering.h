// Answers workloads with the engine.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "answer/answerer.h"
#include "batch/answer_file.h"
#include "batch/query_file.h"
#include "cyber_radar/progress.h"

namespace radar::tools {

struct AnsweringOptions : AnswererOptions {
  AnswerMode mode = AnswerMode::contact;  ///< of queries that do not choose one
  uint32_t resolution = 0;                ///< 0: chosen per sensor
};

/// What answering took.
struct AnsweringStats {
  double ms = 0;                       ///< from handing over the queries to having the answers, scene changes included
  double hostSeconds = 0;              ///< what the calling thread computed in the engine's calls: all but waiting
  uint64_t batches = 0;                ///< calls of the engine's
  uint64_t pairs = 0;                  ///< pairs of triangles or leaves that were looked at, or were proposed by pixels
  uint64_t cpuPairs = 0;               ///< those of them decided on the CPU
  uint64_t cpuQueries = 0;             ///< answered by the CPU alone
  std::array<uint64_t, 5> statuses{};  ///< answers of each Status
  uint32_t leastResolution = kNone, mostResolution = 0;  ///< of the pictures; 0 if none was drawn
  std::vector<StageTime> stages;
};

/// A query that the engine refuses; its message names the query's id.
struct RefusedQuery : InputError {
  RefusedQuery(size_t which, const std::string& id, const std::string& why)
      : InputError("query \"" + id + "\"", "", why), index(which), problem(why) {}
  size_t index;         ///< among those that were to be answered
  std::string problem;  ///< what was expected, as of inKeys()
};

class Answering {
 public:
  /// `world` has the meshes and scenes; it must outlive this. Throws InputError if mode sampled is chosen for a query
  /// that asks for what it does not offer.
  Answering(const Workload& world, const ModesAsked& asked, const AnsweringOptions& options);

  /// Opens what the modes asked for need: no device where the CPU answers everything. Throws radar::Error if none is
  /// usable.
  void open();
  /// open(), shows a scene and brings it to where it is needed. Returns milliseconds, without those for opening.
  double setUp(uint32_t scene);

  /// Answers queries, batch by batch, and adds to stats(). Throws RefusedQuery, too: some limits depend on the sensor's
  /// size, which no reader knows.
  std::vector<Answer> run(std::span<const QuerySpec> queries, Progress& progress);
  /// Throws RefusedQuery if run() would; opens nothing.
  void check(std::span<const QuerySpec> queries);
  /// Since the last reset.
  const AnsweringStats& stats() const { return stats_; }
  void resetStats() { stats_ = {}; }

  const Answerer& answerer() const { return answerer_; }

 private:
  void show(uint32_t scene);
  /// Of the scene that is shown.
  void check(const Batch& batch, std::span<const QuerySpec> queries) const;
  Answers answersOf(const Batch& batch, std::span<const QuerySpec> queries);
  /// Of a chain.
  Answers movesOf(const Batch& batch, std::vector<Answer>& to);

  AnsweringOptions options_;
  AnsweringStats stats_;
  std::vector<AnswerMode> modes_;
  const Workload& world_;
  ScenePlayer player_;
  Answerer answerer_;
  std::map<uint32_t, ChainSweeper> chains_;
};

/// Sets up and answers all queries of a workload.
std::vector<Answer> answersTo(const Workload& workload, Answering& answering, const std::string& label);

/// Whether some query was not answered.
bool someInvalid(std::span<const Answer> answers);

}  // namespace radar::tools
