#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace radar::tools {

/// A bar on standard error, if that is a terminal and the work is long enough to be worth one; else nothing.
class Progress {
 public:
  Progress(std::string what, size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(size_t done);

 private:
  void draw();

  std::string what_;
  size_t total_, done_ = 0;
  bool wanted_, drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace radar::tools
