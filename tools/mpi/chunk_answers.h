// A rank's answers to its chunks.
#pragma once

#include "batch/answer_rows.h"
#include "cyber_radar/query_run.h"
#include "mpi/ranks.h"

namespace radar::tools {

class ChunkAnswers {
 public:
  /// Both must outlive this.
  ChunkAnswers(const QueryFile& queries, Answering& answering, AnswerFormat format)
      : queries_(queries), answering_(answering), rows_(queries.world(), format) {}
  /// Throws nothing: what goes wrong is the failure of the answer.
  Answered answer(Chunk chunk);
  /// Answers chunks from rank 0 until there are no more.
  void serve();

 private:
  const QueryFile& queries_;
  Answering& answering_;
  AnswerRows rows_;
  std::vector<QuerySpec> room_;
};

}  // namespace radar::tools
