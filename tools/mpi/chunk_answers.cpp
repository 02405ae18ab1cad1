#include "mpi/chunk_answers.h"

#include "measure/clock.h"
#include "mpi/ranks.h"

namespace radar::tools {

Answered ChunkAnswers::answer(uint64_t first, std::span<const QuerySpec> queries) {
  Answered answered{first, queries.size()};
  try {
    Progress none;
    const double start = now();
    const std::vector<Answer> answers = answering_.run(queries, none);
    answered.rows = rows_.text(first, queries, answers);
    answered.seconds = now() - start;
    answered.someInvalid = someInvalid(answers);
  } catch (const std::exception& error) {
    answered.failure = error.what();
  }
  return answered;
}

void ChunkAnswers::serve() {
  for (;;) {
    const auto chunk = unpacked<Chunk>(receiveFrom(0));
    if (chunk.queries.empty()) return;
    send(0, packed(answer(chunk.first, chunk.queries)));
  }
}

}  // namespace radar::tools
