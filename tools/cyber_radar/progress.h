// How far work is, and what it took, in words.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <string>

namespace radar::tools {

/// Time for people: "0.31 s", "12 s", "3 min 12 s", "2 h 5 min".
std::string inTime(double seconds);

/// What `done` of `total` pieces took, and how long the others will: "answering [####....] 30 of 60, 12 s left".
std::string progressInWords(const std::string& what, size_t done, size_t total, double seconds);

/// A bar on standard error if that is a terminal and the work takes a while; otherwise nothing.
class Progress {
 public:
  Progress(std::string what, size_t total) : what_(std::move(what)), total_(total) {}
  /// Never a bar.
  Progress() : total_(0), wanted_(false) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  size_t total_, done_ = 0;
  bool wanted_ = isatty(STDERR_FILENO) == 1, drawn_ = false;
  Clock::time_point begun_ = Clock::now(), next_ = begun_ + std::chrono::milliseconds(500);
};

}  // namespace radar::tools
