// Rank 0: hands out chunks of the queries, and writes the answers in their order.
#pragma once

#include <future>
#include <map>
#include <stdexcept>

#include "batch/part_file.h"
#include "cyber_radar/progress.h"
#include "mpi/chunk_answers.h"
#include "mpi/chunk_sizes.h"
#include "mpi/ranks.h"

namespace radar::tools {

/// What ended a rank.
class RankFailure : public std::runtime_error {
 public:
  RankFailure(size_t rank, const std::string& what) : std::runtime_error(what), rank_(rank) {}
  size_t rank() const { return rank_; }

 private:
  size_t rank_;
};

class Coordinator {
 public:
  struct Work {
    uint64_t queries = 0, chunks = 0;
    double seconds = 0;  ///< answering
  };

  /// `ranks`: all, with this one. Both must outlive this.
  Coordinator(PartWriter& writer, uint64_t end, size_t ranks, ChunkAnswers& own);

  /// Answers what `writer` lacks, part of it by `own` on another thread, and ends the other ranks' work. Throws
  /// RankFailure; what is complete until then is written.
  void run();

  const std::vector<Work>& work() const { return work_; }  ///< of each rank
  bool someInvalid() const { return someInvalid_; }

 private:
  void handOut();
  void take(size_t rank, Answered answered);

  PartWriter& writer_;
  ChunkAnswers& own_;
  std::future<Answered> mine_;  ///< of the chunk that this rank has
  ChunkSizes sizes_;
  std::vector<Work> work_;
  std::vector<size_t> held_;            ///< chunks that each rank has
  std::map<uint64_t, Answered> early_;  ///< answers whose turn is not yet
  uint64_t earlyBytes_ = 0;
  uint64_t next_, end_;  ///< the first query not handed out; after the last
  Progress progress_;
  bool someInvalid_ = false;
};

}  // namespace radar::tools
