#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace radar::tools {

/// A bar on standard error if that is a terminal and the work takes a while; otherwise nothing.
class Progress {
 public:
  Progress(std::string what, size_t total) : what_(std::move(what)), total_(total) {}
  /// Never a bar.
  Progress() : total_(0), wanted_(false) {}
  ~Progress() {
    if (drawn_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(size_t done) {
    constexpr size_t kWidth = 40;
    done_ += done;
    if (!wanted_ || Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::milliseconds(100);
    const size_t filled = total_ == 0 ? kWidth : kWidth * done_ / total_;
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    std::fprintf(stderr, "\r%s [%s] %zu of %zu\033[K", what_.c_str(), bar.c_str(), done_, total_);
    std::fflush(stderr);
    drawn_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  size_t total_, done_ = 0;
  bool wanted_ = isatty(STDERR_FILENO) == 1, drawn_ = false;
  Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(500);
};

}  // namespace radar::tools
