// Rank 0's own answers, on a thread beside the one that serves the other ranks: MPI is called by that one alone.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "mpi/messages.h"

namespace radar::tools {

class OwnThread {
 public:
  /// `answer`: answers `count` queries from `first` on; called on the thread.
  explicit OwnThread(std::function<Answered(uint64_t first, uint64_t count)> answer);
  /// Leaves out what was given and is not begun.
  ~OwnThread() = default;

  void give(uint64_t first, uint64_t count);
  /// Waits for answers, but not for long: other ranks may have sent some. Throws what the thread threw.
  std::optional<Answered> take();

 private:
  void work(const std::stop_token& stop);

  std::function<Answered(uint64_t, uint64_t)> answer_;
  std::mutex mutex_;
  std::condition_variable_any given_;  // which wakes when the thread is to stop, too
  std::condition_variable answered_;
  std::deque<std::pair<uint64_t, uint64_t>> waiting_;
  std::deque<Answered> done_;
  std::exception_ptr failed_;
  std::jthread thread_;
};

}  // namespace radar::tools
