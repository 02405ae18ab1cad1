// A rank's answers to its chunks.
#pragma once

#include "batch/answer_rows.h"
#include "cyber_radar/answering.h"
#include "mpi/messages.h"

namespace radar::tools {

class ChunkAnswers {
 public:
  /// Both must outlive this.
  ChunkAnswers(const Workload& world, Answering& answering, AnswerFormat format)
      : answering_(answering), rows_(world, format) {}
  /// Throws nothing: what goes wrong is the failure of the answer.
  Answered answer(uint64_t first, std::span<const QuerySpec> queries);
  /// Answers chunks from rank 0 until there are no more.
  void serve();

 private:
  Answering& answering_;
  AnswerRows rows_;
};

}  // namespace radar::tools
