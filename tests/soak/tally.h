// What a soak has done.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>

namespace radar::soak {

/// Who answered.
enum class Who { cpu, bruteForce, sweeper, sharing, recorder, sharedRecorder, pool, sampled, moved, written };
inline constexpr std::array kWho{
    "CPU",  "brute force", "sweeper",         "sharing sweeper", "recorder", "sharing recorder",
    "pool", "sampled",     "host's geometry", "host's queries"};

/// What was made to fail.
enum class Fault { shortage, lost, memory, notSubmitted, cancelled };
inline constexpr std::array kFaults{"shortage", "device lost", "host memory", "not submitted", "cancelled"};

struct Tally {
  std::array<uint64_t, kWho.size()> answers{};  ///< that were checked
  std::array<uint64_t, kFaults.size()> faults{};
  std::array<double, kWho.size()> seconds{};
  uint64_t invalid = 0;  ///< of the answers: invalid because of a fault
  uint64_t limited = 0;  ///< of the answers: a recorder's that say which limit was too small
  uint64_t wrong = 0, rounds = 0, epochs = 0;

  void add(Who who, size_t count) { answers[static_cast<size_t>(who)] += count; }
  void addSeconds(Who who, double more) { seconds[static_cast<size_t>(who)] += more; }
  void add(Fault fault) { ++faults[static_cast<size_t>(fault)]; }
  uint64_t allAnswers() const { return std::accumulate(answers.begin(), answers.end(), uint64_t{0}); }
  uint64_t allFaults() const { return std::accumulate(faults.begin(), faults.end(), uint64_t{0}); }
};

}  // namespace radar::soak
