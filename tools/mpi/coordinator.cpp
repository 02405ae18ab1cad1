#include "mpi/coordinator.h"

#include <chrono>
#include <thread>

namespace radar::tools {

Coordinator::Coordinator(PartWriter& writer, uint64_t end, size_t ranks, ChunkAnswers& own)
    : writer_(writer),
      own_(own),
      sizes_(ranks),
      work_(ranks),
      held_(ranks),
      next_(writer.next()),
      end_(end),
      progress_("answering", end - writer.next()),
      someInvalid_(writer.kept(Status::invalid) > 0) {}

void Coordinator::run() {
  using namespace std::chrono_literals;
  while (writer_.next() < end_) {
    handOut();
    if (mine_.valid() && mine_.wait_for(0s) == std::future_status::ready) {
      take(0, mine_.get());
    } else if (std::optional<Received> received = receiveIfAny()) {
      take(static_cast<size_t>(received->rank), std::move(received->answered));
    } else {
      std::this_thread::sleep_for(500us);
    }
  }
  for (size_t rank = 1; rank < held_.size(); ++rank) send(static_cast<int>(rank), Chunk());
}

// A second chunk waits at each other rank while it answers the first.
void Coordinator::handOut() {
  constexpr uint64_t kMostEarly = 1u << 30;  // bytes of answers that wait for a slow chunk
  for (size_t depth = 0; depth < 2; ++depth) {
    for (size_t rank = depth; rank < held_.size(); ++rank) {
      if (held_[rank] > depth || next_ == end_ || earlyBytes_ >= kMostEarly) continue;
      const Chunk chunk{next_, sizes_.next(rank, end_ - next_)};
      if (rank == 0) {
        mine_ = std::async(std::launch::async, [this, chunk] { return own_.answer(chunk); });
      } else {
        send(static_cast<int>(rank), chunk);
      }
      ++held_[rank];
      next_ += chunk.count;
    }
  }
}

void Coordinator::take(size_t rank, Answered answered) {
  if (answered.failed) throw RankFailure(rank, answered.text);
  const auto [first, count] = answered.chunk;
  --held_[rank];
  sizes_.answered(rank, count, answered.seconds);
  handOut();  // before writing takes its time
  work_[rank].queries += count;
  ++work_[rank].chunks;
  work_[rank].seconds += answered.seconds;
  someInvalid_ = someInvalid_ || answered.someInvalid;
  progress_.add(count);
  earlyBytes_ += answered.text.size();
  early_.emplace(first, std::move(answered));
  while (!early_.empty() && early_.begin()->first == writer_.next()) {
    const Answered& turn = early_.begin()->second;
    writer_.append(turn.text, turn.chunk.count);
    earlyBytes_ -= turn.text.size();
    early_.erase(early_.begin());
  }
}

}  // namespace radar::tools
