// Where batches wait and workers take chunks of them. Every function may be called from any thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "pool/share.h"
#include "radar/pool.h"

namespace radar {

/// A batch on its way. Queries of one mode stand together, so that a chunk is one submission: `place` says where each
/// stood.
struct Job {
  std::vector<Query> queries;
  std::vector<uint32_t> place;
  std::stop_token stop;
  std::promise<PoolAnswers> promise;
  PoolAnswers answers;
  size_t taken = 0, answered = 0;
  std::vector<bool> took, passed;  ///< by worker: has taken some, has let others go first
};

/// Queries [first, first + count) of a job.
struct Chunk {
  std::shared_ptr<Job> job;
  size_t first = 0, count = 0;
  bool outOfMemory = false;  ///< a device has failed to allocate for it

  std::span<const Query> queries() const { return std::span<const Query>(job->queries).subspan(first, count); }
};

class Exchange {
 public:
  explicit Exchange(std::vector<PoolDevice> devices);

  std::future<PoolAnswers> post(std::vector<Query> queries, std::stop_token stop, const Scene& scene);
  void edit(const std::function<void()>& change);
  void drain();
  /// Answers what is not taken, and lets workers go.
  void close();
  std::vector<PoolDevice> devices() const;

  // For workers.

  /// The next chunk for a worker with so many queries in flight. Sleeps until there is one, unless it has some in
  /// flight; nothing then, or when it is to go.
  std::optional<Chunk> take(uint32_t worker, size_t inFlight);
  /// `deviceMs`: how long the device was at it; 0 if that says nothing of its speed.
  void deliver(const Chunk& chunk, std::span<const Result> results, const std::map<size_t, std::string>& reasons,
               const SweepStats& stats, ChunkTrace trace, double deviceMs);
  /// The worker ends; its chunks go to the others.
  void retire(uint32_t worker, const std::string& reason, std::vector<Chunk> chunks);
  /// The worker gets no more chunks, and is about to retire; false, and nothing changes, if no other is left. Of two
  /// that ask at once, one stays.
  bool leave(uint32_t worker);

  /// Milliseconds since this was made.
  double now() const { return at(std::chrono::steady_clock::now()); }
  double at(std::chrono::steady_clock::time_point when) const {
    return std::chrono::duration<double, std::milli>(when - start_).count();
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  size_t waiting() const;
  std::optional<Chunk> next(uint32_t worker, size_t inFlight);
  void answerUntaken(const std::string& reason);
  void giveUp(Job& job, size_t first, size_t count, const std::string& reason);
  void settle(Job& job, size_t count);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_;
  std::condition_variable work_, settled_, edited_;
  std::vector<PoolDevice> devices_;
  Share share_;
  std::deque<std::shared_ptr<Job>> jobs_;   // with queries that nobody has taken
  std::deque<Chunk> returned_;              // by retired workers
  std::vector<std::shared_ptr<Job>> open_;  // not yet answered, in the order of submission
  bool editing_ = false, closed_ = false;
};

}  // namespace radar
