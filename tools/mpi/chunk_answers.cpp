#include "mpi/chunk_answers.h"

#include "measure/clock.h"

namespace radar::tools {

Answered ChunkAnswers::answer(Chunk chunk) {
  Answered answered{{.chunk = chunk}, {}};
  try {
    Progress none;
    const double start = now();
    const std::span<const QuerySpec> queries = queries_.read(chunk.first, chunk.count, room_);
    const std::vector<Answer> answers = placed(queries_, chunk.first, [&] { return answering_.run(queries, none); });
    answered.text = rows_.text(chunk.first, queries, answers);
    answered.seconds = now() - start;
    answered.someInvalid = someInvalid(answers);
  } catch (const std::exception& error) {
    answered.failed = true;
    answered.text = error.what();
  }
  return answered;
}

void ChunkAnswers::serve() {
  for (Chunk chunk = receiveChunk(); chunk.count > 0; chunk = receiveChunk()) send(answer(chunk));
}

}  // namespace radar::tools
