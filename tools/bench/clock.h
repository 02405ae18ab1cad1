// What some work takes, on three clocks.
#pragma once

#include <time.h>

#include <cmath>

namespace radar::bench {

inline double readClock(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds since some point in the past.
inline double now() {
  return readClock(CLOCK_MONOTONIC);
}

/// What some work took, seconds.
struct Lap {
  double process = 0;  ///< computed by all threads of the process
  double thread = 0;   ///< computed by the calling thread
  double wall = 0;     ///< passed
  Lap& operator+=(const Lap& other) {
    process += other.process;
    thread += other.thread;
    wall += other.wall;
    return *this;
  }
};

class Stopwatch {
 public:
  /// Since construction. The clock of the time passed is the last to be started and the first to be read.
  Lap lap() const {
    Lap lap;
    lap.wall = now() - start_.wall;
    lap.thread = readClock(CLOCK_THREAD_CPUTIME_ID) - start_.thread;
    lap.process = readClock(CLOCK_PROCESS_CPUTIME_ID) - start_.process;
    return lap;
  }

 private:
  Lap start_{readClock(CLOCK_PROCESS_CPUTIME_ID), readClock(CLOCK_THREAD_CPUTIME_ID), now()};
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

}  // namespace radar::bench
