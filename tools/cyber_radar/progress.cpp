#include "cyber_radar/progress.h"

#include <unistd.h>

#include <cstdio>

namespace radar::tools {

namespace {

constexpr auto kPatience = std::chrono::milliseconds(500), kInterval = std::chrono::milliseconds(100);
constexpr size_t kWidth = 40;

}  // namespace

Progress::Progress(std::string what, size_t total)
    : what_(std::move(what)),
      total_(total),
      wanted_(isatty(STDERR_FILENO) == 1),
      next_(std::chrono::steady_clock::now() + kPatience) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::add(size_t done) {
  done_ += done;
  if (!wanted_ || std::chrono::steady_clock::now() < next_) return;
  next_ = std::chrono::steady_clock::now() + kInterval;
  draw();
}

void Progress::draw() {
  const size_t filled = total_ == 0 ? kWidth : kWidth * done_ / total_;
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  std::fprintf(stderr, "\r%s [%s] %zu of %zu\033[K", what_.c_str(), bar.c_str(), done_, total_);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace radar::tools
