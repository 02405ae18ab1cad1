// What some work takes, on two clocks.
#pragma once

#include <time.h>

#include <cmath>
#include <cstdint>

namespace radar::tools {

/// Nanoseconds since some point in the past.
inline int64_t readClock(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

/// Seconds that have passed since some point in the past.
inline double now() {
  return 1e-9 * static_cast<double>(readClock(CLOCK_MONOTONIC));
}

/// Seconds that the calling thread has computed.
inline double threadSeconds() {
  return 1e-9 * static_cast<double>(readClock(CLOCK_THREAD_CPUTIME_ID));
}

/// What some work took, seconds.
struct Lap {
  double process = 0;  ///< computed by all threads of the process
  double wall = 0;     ///< passed
  Lap& operator+=(const Lap& other) {
    process += other.process;
    wall += other.wall;
    return *this;
  }
};

class Stopwatch {
 public:
  /// Since construction. The clock of the time passed is the last to be started and the first to be read.
  Lap lap() const {
    const int64_t wall = readClock(CLOCK_MONOTONIC) - wall_, process = readClock(CLOCK_PROCESS_CPUTIME_ID) - process_;
    return {1e-9 * static_cast<double>(process), 1e-9 * static_cast<double>(wall)};
  }

 private:
  int64_t process_ = readClock(CLOCK_PROCESS_CPUTIME_ID);
  int64_t wall_ = readClock(CLOCK_MONOTONIC);
};

template <class Work>
Lap lapOf(const Work& work) {
  const Stopwatch stopwatch;
  work();
  return stopwatch.lap();
}

class Deadline {
 public:
  explicit Deadline(double seconds = INFINITY) : end_(now() + seconds) {}
  double left() const { return end_ - now(); }
  bool isOver() const { return left() <= 0; }

 private:
  double end_;
};

}  // namespace radar::tools
