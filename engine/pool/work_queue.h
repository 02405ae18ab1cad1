// The queue of batches, from which workers take chunks. Any thread may call any function.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "pool/chunk_scheduler.h"
#include "query/hits.h"
#include "radar/pool.h"
#include "scene/scene.h"

namespace radar {

/// A batch in progress.
struct Job {
  std::vector<Query> queries;
  Mode mode = Mode::contact;
  std::stop_token stop;
  std::promise<PoolAnswers> promise;
  PoolAnswers answers;
  size_t taken = 0, answered = 0;
  bool hasEnded = false;           ///< the future has its answers, or an exception
  std::vector<bool> took, passed;  ///< by worker: has taken a chunk, has deferred to others
};

/// Queries [first, first + count) of a job.
struct Chunk {
  std::shared_ptr<Job> job;
  size_t first = 0, count = 0;
  bool outOfMemory = false;  ///< an allocation for it has failed on one device

  std::span<const Query> queries() const { return std::span<const Query>(job->queries).subspan(first, count); }
};

class WorkQueue {
 public:
  explicit WorkQueue(std::vector<PoolDevice> devices);

  std::future<PoolAnswers> post(std::vector<Query> queries, Mode mode, std::stop_token stop, const Scene& scene);
  void edit(const std::function<void()>& change);
  /// Answers queries not yet taken as invalid, and lets workers end.
  void close();
  std::vector<PoolDevice> devices() const;

  // Called by workers.

  /// The next chunk for a worker with `inFlight` queries in flight. If there is none: sleeps, unless the worker has
  /// queries in flight or is to end; then returns nothing.
  std::optional<Chunk> take(uint32_t worker, size_t inFlight);
  /// Stores a chunk's answers, unless its batch has ended. `deviceMs`: time on the device; 0 if it is no measure of the
  /// device's speed.
  void deliver(const Chunk& chunk, Answers found, ChunkTrace trace, double deviceMs);
  /// Ends the worker; its chunks go to the others.
  void retire(uint32_t worker, const std::string& reason, std::vector<Chunk> chunks);
  /// Ends the batch of a chunk: its future gets the exception.
  void abandon(const Chunk& chunk, const std::exception_ptr& exception);
  /// Gives the worker no more chunks: it is about to retire. Returns false, and changes nothing, if it is the only one
  /// left; if the last two call at once, one stays.
  bool leave(uint32_t worker);
  /// Records why the last worker, which stays, no longer uses its device.
  void giveUp(uint32_t worker, const std::string& reason);

  /// Milliseconds since this was made.
  double now() const { return at(std::chrono::steady_clock::now()); }
  double at(std::chrono::steady_clock::time_point when) const {
    return std::chrono::duration<double, std::milli>(when - start_).count();
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  size_t waiting() const;
  std::optional<Chunk> next(uint32_t worker, size_t inFlight);
  void report(uint32_t worker, const std::string& reason);
  void answerUntaken(const char* reason);
  void fail(const std::shared_ptr<Job>& job, size_t first, size_t count, const char* reason);
  void settle(const std::shared_ptr<Job>& job, size_t count);
  void giveBack(size_t chunks);
  void end(const std::shared_ptr<Job>& job, const std::exception_ptr& exception);
  template <class Work>
  void orEnd(const std::shared_ptr<Job>& job, const Work& work);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_;
  std::condition_variable work_, settled_, edited_;
  std::vector<PoolDevice> devices_;
  ChunkScheduler share_;
  std::deque<std::shared_ptr<Job>> jobs_;   // with queries not yet taken
  std::deque<Chunk> returned_;              // from retired workers
  std::vector<std::shared_ptr<Job>> open_;  // not yet answered, in the order of submission
  size_t posting_ = 0;                      // batches that are being checked
  size_t taken_ = 0;                        // chunks with workers
  bool editing_ = false, closed_ = false;
};

}  // namespace radar
