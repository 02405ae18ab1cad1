// Answers held against the exact answer, that of the CPU's search.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>

#include "radar/radar.h"

namespace radar::tools {

/// hit or overlap.
bool meets(const Result& result);

/// What can be wrong with an answer.
enum class Fault {
  missed,       ///< no contact, where there is one within D
  falseHit,     ///< a contact, where there is none within D
  unanswered,   ///< invalid
  wrongStatus,  ///< hit for overlap or the other way, or not detected
  wrongPair,    ///< the object or a triangle
  wrongList,    ///< the objects that are skipped, or the contacts listed
  bracket,      ///< t* is not in [lo, hi], or hi is beyond D; in mode contact: lo or hi is another
  late,         ///< in mode contact: t or the fraction is another
  point,        ///< likewise the point or the gap
  normal        ///< likewise the normal
};
inline constexpr size_t kFaults = 10;
const char* nameOf(Fault fault);

class Verdict {
 public:
  bool unseen = false;  ///< in mode sampled: undecided, where there is a contact
  bool found = false;   ///< a contact, where there is one
  double error = 0;     ///< t - t* of a contact that was found, in units

  /// A fault that was found stays.
  void set(Fault fault, bool is = true) {
    faults_[static_cast<size_t>(fault)] = faults_[static_cast<size_t>(fault)] || is;
  }
  bool operator[](Fault fault) const { return faults_[static_cast<size_t>(fault)]; }
  bool right() const { return faults_.none(); }
  /// What is wrong, in words; empty if nothing is.
  std::string words() const;

 private:
  std::bitset<kFaults> faults_;
};

/// Missed, false hit and bracket are judged; NaN: no bound. Errors are in units of `unit`. Throws Error if the query
/// was not answered.
Verdict judge(const Result& result, const Result& exact, double unit);

/// What errors are relative to: max(size of the sensor, t*).
double unitOf(const Scene& scene, const Query& query, const Result& exact);

/// All that an answer promises: in mode contact the bits of `exact`, the CPU's to the same query, but for the tier and
/// the sign of 0. In mode sampled `exact` is the CPU's first contact, `lo` must be 0, and pair, t, point and normal are
/// not judged.
Verdict judge(const Scene& scene, const Query& query, Mode mode, const Result& result, const Result& exact);

/// Verdicts added up, and what the answers cost.
struct Tally {
  uint64_t queries = 0, hits = 0, clear = 0, overlaps = 0;  ///< by the exact answers
  uint64_t unseen = 0;
  uint64_t wrong = 0;  ///< answers with any fault
  std::array<uint64_t, kFaults> faults{};
  double late = 0, early = 0;  ///< the largest errors, in units
  uint64_t pairs = 0, cpuPairs = 0;
  double deviceSeconds = 0, cpuSeconds = 0;

  uint64_t operator[](Fault fault) const { return faults[static_cast<size_t>(fault)]; }
  uint64_t contacts() const { return hits + overlaps; }
  void add(const Verdict& verdict, const Result& exact);
  void add(const Tally& other);
};

}  // namespace radar::tools
