#include "pool/work_queue.h"

#include <algorithm>
#include <new>
#include <utility>

#include "gpu/submission.h"
#include "query/route.h"

namespace radar {

namespace {

void addStats(SweepStats& sum, const SweepStats& stats) {
  sum.submissions += stats.submissions;
  sum.drawnObjects += stats.drawnObjects;
  sum.drawnTriangles += stats.drawnTriangles;
  sum.pairs += stats.pairs;
  sum.cpuPairs += stats.cpuPairs;
  sum.cpuQueries += stats.cpuQueries;
  if (sum.lost.empty()) sum.lost = stats.lost;
  for (const StageTime& stage : stats.stages) gpu::addStageTime(sum.stages, stage.name, stage.ms);
}

std::shared_ptr<Job> jobOf(std::vector<Query> queries, Mode mode, std::stop_token stop, size_t workers) {
  auto job = std::make_shared<Job>();
  job->took.resize(workers);
  job->passed.resize(workers);
  job->stop = std::move(stop);
  static_cast<Answers&>(job->answers) = unanswered(queries);
  job->queries = std::move(queries);
  job->mode = mode;
  return job;
}

}  // namespace

WorkQueue::WorkQueue(std::vector<PoolDevice> devices) : devices_(std::move(devices)), share_(devices_.size()) {}

std::future<PoolAnswers> WorkQueue::post(std::vector<Query> queries, Mode mode, std::stop_token stop,
                                         const Scene& scene) {
  const double submitted = now();
  Lock lock(mutex_);
  edited_.wait(lock, [&] { return !editing_; });
  // Workers go on while the batch is checked, but the scene must not change.
  ++posting_;
  lock.unlock();
  std::shared_ptr<Job> job;
  try {
    requireValid(queries, scene, mode);
    job = jobOf(std::move(queries), mode, std::move(stop), devices_.size());
  } catch (...) {
    lock.lock();
    --posting_;
    settled_.notify_all();
    throw;
  }
  job->answers.submitted = submitted;
  std::future<PoolAnswers> future = job->promise.get_future();
  lock.lock();
  --posting_;
  settled_.notify_all();
  if (!job->queries.empty()) jobs_.push_back(job);
  try {
    open_.push_back(job);
  } catch (...) {
    std::erase(jobs_, job);
    throw;
  }
  if (job->queries.empty()) {
    settle(job, 0);
  } else if (share_.alive() == 0) {
    answerUntaken(nullptr);
  } else {
    work_.notify_all();
  }
  return future;
}

void WorkQueue::edit(const std::function<void()>& change) {
  struct Editing {
    WorkQueue& exchange;
    ~Editing() {
      {
        const Lock lock(exchange.mutex_);
        exchange.editing_ = false;
      }
      exchange.edited_.notify_all();
    }
  };
  {
    Lock lock(mutex_);
    edited_.wait(lock, [&] { return !editing_; });
    editing_ = true;
    // A batch that has ended early may still have chunks with workers.
    settled_.wait(lock, [&] { return open_.empty() && posting_ == 0 && taken_ == 0; });
  }
  const Editing editing{*this};
  change();
}

void WorkQueue::close() {
  {
    const Lock lock(mutex_);
    closed_ = true;
    answerUntaken("the pool was closed");
  }
  work_.notify_all();
}

std::vector<PoolDevice> WorkQueue::devices() const {
  const Lock lock(mutex_);
  return devices_;
}

bool WorkQueue::leave(uint32_t worker) {
  const Lock lock(mutex_);
  if (share_.alive() == 1) return false;
  share_.retire(worker);
  return true;
}

// Number of queries not yet taken.
size_t WorkQueue::waiting() const {
  size_t count = 0;
  for (const Chunk& chunk : returned_) count += chunk.count;
  for (const auto& job : jobs_) count += job->queries.size() - job->taken;
  return count;
}

std::optional<Chunk> WorkQueue::next(uint32_t worker, size_t inFlight) {
  if (!returned_.empty()) {
    if (share_.take(worker, returned_.front().count, waiting(), inFlight) == 0) return {};
    Chunk chunk = std::move(returned_.front());
    returned_.pop_front();
    return chunk;
  }
  while (!jobs_.empty() && jobs_.front()->stop.stop_requested()) {
    const std::shared_ptr<Job> job = std::move(jobs_.front());
    jobs_.pop_front();
    fail(job, job->taken, job->queries.size() - job->taken, "cancelled");
  }
  if (jobs_.empty()) return {};
  const std::shared_ptr<Job> job = jobs_.front();
  const size_t left = job->queries.size() - job->taken;
  const Chunk chunk{job, job->taken, share_.take(worker, left, waiting(), inFlight)};
  if (chunk.count == 0) {
    if (inFlight == 0) job->passed[worker] = true;
    return {};
  }
  job->took[worker] = true;
  job->taken += chunk.count;
  if (job->taken == job->queries.size()) {
    jobs_.pop_front();
    for (size_t i = 0; i < devices_.size(); ++i) {
      if (job->passed[i] && !job->took[i]) share_.passed(i);
    }
  }
  return chunk;
}

std::optional<Chunk> WorkQueue::take(uint32_t worker, size_t inFlight) {
  Lock lock(mutex_);
  for (;;) {
    std::optional<Chunk> chunk = next(worker, inFlight);
    if (chunk) ++taken_;
    if (chunk || inFlight > 0 || closed_) return chunk;
    work_.wait(lock);
  }
}

void WorkQueue::deliver(const Chunk& chunk, Answers found, ChunkTrace trace, double deviceMs) {
  const Lock lock(mutex_);
  giveBack(1);
  PoolDevice& device = devices_[trace.device];
  device.queries += chunk.count;
  ++device.chunks;
  share_.finished(trace.device, chunk.count, deviceMs);
  Job& job = *chunk.job;
  orEnd(chunk.job, [&] {
    const auto first = static_cast<ptrdiff_t>(chunk.first);
    std::copy(found.results.begin(), found.results.end(), job.answers.results.begin() + first);
    std::move(found.lists.begin(), found.lists.end(), job.answers.lists.begin() + first);
    for (const auto& [i, reason] : found.reasons) job.answers.reasons[chunk.first + i] = reason;
    addStats(job.answers.stats, found.stats);
    job.answers.chunks.push_back(std::move(trace));
  });
  settle(chunk.job, chunk.count);
  if (waiting() > 0) work_.notify_all();  // estimated speeds have changed, so a worker that deferred may be needed now
}

void WorkQueue::report(uint32_t worker, const std::string& reason) {
  devices_[worker].retired = reason;
  const std::string line = "device " + std::to_string(worker) + ", " + devices_[worker].name + ": " + reason;
  for (const auto& job : open_) job->answers.retired.push_back(line);
}

void WorkQueue::giveUp(uint32_t worker, const std::string& reason) {
  const Lock lock(mutex_);
  if (devices_[worker].retired.empty()) report(worker, reason);
}

void WorkQueue::retire(uint32_t worker, const std::string& reason, std::vector<Chunk> chunks) {
  {
    const Lock lock(mutex_);
    giveBack(chunks.size());
    share_.retire(worker);
    try {
      report(worker, reason);
      for (Chunk& chunk : chunks) returned_.push_back(std::move(chunk));
    } catch (const std::bad_alloc&) {
      while (!open_.empty()) end(std::shared_ptr<Job>(open_.front()), std::current_exception());
    }
    if (share_.alive() == 0) answerUntaken(nullptr);
    if (closed_) answerUntaken("the pool was closed");
  }
  work_.notify_all();  // workers that deferred to others may be needed now
}

void WorkQueue::abandon(const Chunk& chunk, const std::exception_ptr& exception) {
  const Lock lock(mutex_);
  giveBack(1);
  end(chunk.job, exception);
}

void WorkQueue::giveBack(size_t chunks) {
  taken_ -= chunks;
  if (taken_ == 0) settled_.notify_all();
}

// No reason stands for the list of retired devices.
void WorkQueue::answerUntaken(const char* reason) {
  while (!returned_.empty()) {
    const Chunk chunk = std::move(returned_.front());
    returned_.pop_front();
    fail(chunk.job, chunk.first, chunk.count, reason);
  }
  while (!jobs_.empty()) {
    const std::shared_ptr<Job> job = std::move(jobs_.front());
    jobs_.pop_front();
    fail(job, job->taken, job->queries.size() - job->taken, reason);
  }
}

void WorkQueue::fail(const std::shared_ptr<Job>& job, size_t first, size_t count, const char* reason) {
  orEnd(job, [&] {
    std::string why = reason == nullptr ? "no device is left" : reason;
    for (size_t i = 0; reason == nullptr && i < devices_.size(); ++i) {
      why += (i == 0 ? ": device " : "; device ") + std::to_string(i) + ", " + devices_[i].name + ": " +
             devices_[i].retired;
    }
    for (size_t i = first; i < first + count; ++i) job->answers.reasons[i] = why;
  });
  settle(job, count);
}

// Counts answered queries; the last one ends the job.
void WorkQueue::settle(const std::shared_ptr<Job>& job, size_t count) {
  job->answered += count;
  if (job->answered < job->queries.size()) return;
  orEnd(job, [&] {
    job->answers.answered = now();
    end(job, nullptr);
  });
}

// Does what allocates memory; ends a job for which there is none.
template <class Work>
void WorkQueue::orEnd(const std::shared_ptr<Job>& job, const Work& work) {
  if (job->hasEnded) return;
  try {
    work();
  } catch (const std::bad_alloc&) {
    end(job, std::current_exception());
  }
}

// Gives the future the answers, or an exception. Workers may still have chunks of the job.
void WorkQueue::end(const std::shared_ptr<Job>& job, const std::exception_ptr& exception) {
  if (std::exchange(job->hasEnded, true)) return;
  const std::shared_ptr<Job> kept = job;
  const auto isIt = [&](const auto& other) { return other == kept; };
  std::erase_if(jobs_, isIt);
  std::erase_if(open_, isIt);
  std::erase_if(returned_, [&](const Chunk& chunk) { return chunk.job == kept; });
  if (exception) {
    kept->promise.set_exception(exception);
  } else {
    kept->promise.set_value(std::move(kept->answers));
  }
  settled_.notify_all();
}

}  // namespace radar
