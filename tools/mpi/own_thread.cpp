#include "mpi/own_thread.h"

#include <chrono>

namespace radar::tools {

OwnThread::OwnThread(std::function<Answered(uint64_t first, uint64_t count)> answer)
    : answer_(std::move(answer)), thread_([this](const std::stop_token& stop) {
        try {
          work(stop);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          failed_ = std::current_exception();
        }
      }) {}

void OwnThread::give(uint64_t first, uint64_t count) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.emplace_back(first, count);
  }
  given_.notify_one();
}

std::optional<Answered> OwnThread::take() {
  std::unique_lock lock(mutex_);
  answered_.wait_for(lock, std::chrono::microseconds(500), [&] { return !done_.empty(); });
  if (failed_) std::rethrow_exception(failed_);
  if (done_.empty()) return std::nullopt;
  Answered first = std::move(done_.front());
  done_.pop_front();
  return first;
}

void OwnThread::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (given_.wait(lock, stop, [&] { return !waiting_.empty(); }) && !stop.stop_requested()) {
    const auto [first, count] = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    Answered answered = answer_(first, count);
    lock.lock();
    done_.push_back(std::move(answered));
    answered_.notify_one();
  }
}

}  // namespace radar::tools
