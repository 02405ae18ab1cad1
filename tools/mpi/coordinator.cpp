#include "mpi/coordinator.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace radar::tools {

// Rank 0 computes, too, while its main thread serves the others: MPI is called by that one alone.
class Coordinator::OwnThread {
 public:
  OwnThread(const QueryFile& queries, ChunkAnswers& answers)
      : queries_(queries), answers_(answers), thread_([this](const std::stop_token& stop) { work(stop); }) {}
  ~OwnThread() {
    thread_.request_stop();
    given_.notify_all();
  }

  void give(uint64_t first, uint64_t count) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.emplace_back(first, count);
    }
    given_.notify_one();
  }
  /// Waits for answers, but not for long: other ranks may have sent some.
  std::optional<Answered> take() {
    std::unique_lock lock(mutex_);
    answered_.wait_for(lock, std::chrono::microseconds(500), [&] { return !done_.empty(); });
    if (done_.empty()) return std::nullopt;
    Answered first = std::move(done_.front());
    done_.pop_front();
    return first;
  }

 private:
  void work(const std::stop_token& stop) {
    std::vector<QuerySpec> room;
    for (;;) {
      std::pair<uint64_t, uint64_t> chunk;
      {
        std::unique_lock lock(mutex_);
        given_.wait(lock, [&] { return stop.stop_requested() || !waiting_.empty(); });
        if (stop.stop_requested()) return;
        chunk = waiting_.front();
        waiting_.pop_front();
      }
      Answered answered = answers_.answer(chunk.first, queries_.read(chunk.first, chunk.second, room));
      {
        const std::lock_guard lock(mutex_);
        done_.push_back(std::move(answered));
      }
      answered_.notify_one();
    }
  }

  const QueryFile& queries_;
  ChunkAnswers& answers_;
  std::mutex mutex_;
  std::condition_variable given_, answered_;
  std::deque<std::pair<uint64_t, uint64_t>> waiting_;
  std::deque<Answered> done_;
  std::jthread thread_;
};

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
  OwnThread thread(queries_, own);
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
