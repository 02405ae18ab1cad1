#include "mpi/coordinator.h"

namespace radar::tools {

Coordinator::Coordinator(const QueryFile& queries, PartWriter& writer, uint64_t end, size_t ranks)
    : queries_(queries),
      writer_(writer),
      sizes_(ranks),
      work_(ranks),
      held_(ranks),
      next_(writer.next()),
      end_(end),
      progress_("answering", end - writer.next()),
      someInvalid_(writer.keptInvalid()) {}

void Coordinator::run(ChunkAnswers& own) {
  OwnThread thread([&, room = std::vector<QuerySpec>()](uint64_t first, uint64_t count) mutable {
    return own.answer(first, queries_.read(first, count, room));
  });
  while (writer_.next() < end_) {
    handOut(thread);
    bool isIdle = true;
    while (const std::optional<Received> received = receiveIfAny()) {
      take(static_cast<size_t>(received->rank), unpacked<Answered>(received->bytes));
      isIdle = false;
    }
    outbox_.tidy();
    if (!isIdle) continue;
    if (std::optional<Answered> answered = thread.take()) take(0, std::move(*answered));
  }
  for (size_t rank = 1; rank < held_.size(); ++rank) outbox_.send(static_cast<int>(rank), packed(Chunk()));
  outbox_.wait();
}

// A second chunk waits at each rank while it answers the first.
void Coordinator::handOut(OwnThread& own) {
  constexpr uint64_t kMostEarly = 1u << 30;  // bytes of answers that wait for a slow chunk
  for (size_t depth = 0; depth < 2; ++depth) {
    for (size_t rank = 0; rank < held_.size(); ++rank) {
      if (held_[rank] <= depth && next_ < end_ && earlyBytes_ < kMostEarly) give(rank, own);
    }
  }
}

void Coordinator::give(size_t rank, OwnThread& own) {
  const uint64_t count = sizes_.next(rank, end_ - next_);
  if (rank == 0) {
    own.give(next_, count);
  } else {
    std::vector<QuerySpec> room;
    const std::span<const QuerySpec> queries = queries_.read(next_, count, room);
    outbox_.send(static_cast<int>(rank), packed(Chunk{next_, {queries.begin(), queries.end()}}));
  }
  ++held_[rank];
  next_ += count;
}

void Coordinator::take(size_t rank, Answered answered) {
  if (!answered.failure.empty()) throw RankFailure(rank, answered.failure);
  --held_[rank];
  sizes_.answered(rank, answered.count, answered.seconds);
  work_[rank].queries += answered.count;
  ++work_[rank].chunks;
  work_[rank].seconds += answered.seconds;
  someInvalid_ = someInvalid_ || answered.someInvalid;
  progress_.add(answered.count);
  earlyBytes_ += answered.rows.size();
  early_.emplace(answered.first, std::move(answered));
  while (!early_.empty() && early_.begin()->first == writer_.next()) {
    const Answered& turn = early_.begin()->second;
    writer_.append(turn.rows, turn.count);
    earlyBytes_ -= turn.rows.size();
    early_.erase(early_.begin());
  }
}

}  // namespace radar::tools
