// Learns which side answers a batch of mode contact sooner, the device or the CPU, from the batches themselves. Both
// give the same answers, so a choice costs time at most. Independent of devices and clocks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace radar {

enum class Side { cpu, device };

/// What sets the cost of a query on the sides apart: with a clearance, the device leaves the end to the CPU; it takes a
/// search past each object in reach, where the CPU takes one (Route::searchEach); neither.
enum class BatchKind { plain, clearance, each };

/// How long batches take on each side: a curve to start from, which batch_router.cpp states with its source, times a
/// factor for each kind and power of two of queries, learnt from the latest batches. Where none is known, that of the
/// nearest power is taken.
class BatchTimes {
 public:
  /// `threads`: of the CPU's search.
  explicit BatchTimes(unsigned threads) : threads_(threads) {}
  /// What is known, for other threads.
  BatchTimes with(unsigned threads) const;

  /// Seconds. `queries`: at least one, here and below.
  double expected(Side side, BatchKind kind, size_t queries) const;
  void took(Side side, BatchKind kind, size_t queries, double seconds);
  /// How many powers of two lie between the batch and the nearest that is known of the side; kUnknown: more, or none
  /// is.
  uint32_t distance(Side side, BatchKind kind, size_t queries) const;

  static constexpr uint32_t kUnknown = 2;
  static constexpr uint32_t kPowers = 33;
  /// That is nearest to so many queries.
  static uint32_t powerOf(size_t queries);

 private:
  struct Figure {
    float factor = 1;
    uint32_t batches = 0;  ///< from which it was learnt; counts up to kRemembered
  };
  using Figures = std::array<Figure, kPowers>;

  double curve(Side side, size_t queries) const;
  const Figures& of(Side side, BatchKind kind) const {
    return figures_[static_cast<size_t>(side)][static_cast<size_t>(kind)];
  }
  /// The power nearest to `power` of which anything is known; kPowers: there is none.
  static uint32_t nearestKnown(const Figures& figures, uint32_t power);

  unsigned threads_;
  std::array<std::array<Figures, 3>, 2> figures_{};
};

/// Chooses the side from which less time is expected. So each wrong expectation by which a side is chosen is corrected
/// by the first batches that it answers.
///
/// The other side may have become, or may always have been, the faster one: now and then it is tried. All batches save
/// kTriesShare of their time for that; a try pays what it is expected to lose, 1 + d + l times, where d is distance()
/// and l the number of tries in a row that have lost here. What it loses beyond that is charged afterwards. So tries
/// lose at most kTriesShare of the time of all batches, and once what one lost beyond its price. No try is expected to
/// take both kMostTimes as long as the other side and kMostExtra longer. At least kBetween batches lie between two, so
/// that of sides that seem alike both are measured.
class BatchRouter {
 public:
  explicit BatchRouter(const BatchTimes& known) : times_(known) {}

  struct Choice {
    Side side = Side::cpu;
    BatchKind kind = BatchKind::plain;
    size_t queries = 0;
    double otherwise = 0;  ///< seconds that are expected of the other side
    double price = 0;      ///< that a try has paid, seconds; 0: it is none
  };
  Choice choose(BatchKind kind, size_t queries);
  /// The batch took so long on the side that was chosen. To be called once for a choice, or never.
  void took(const Choice& choice, double seconds);

  const BatchTimes& times() const { return times_; }
  bool hasLearnt() const { return hasLearnt_; }

  static constexpr double kTriesShare = 1.0 / 32;
  static constexpr double kMostTimes = 8, kMostExtra = 10e-3;
  static constexpr uint32_t kBetween = 2;

 private:
  using Counts = std::array<uint8_t, BatchTimes::kPowers>;

  BatchTimes times_;
  bool hasLearnt_ = false;
  uint32_t sinceTry_ = 0;
  double saved_ = 0;                             ///< seconds that tries may lose
  std::array<std::array<Counts, 3>, 2> lost_{};  ///< tries in a row that the side has lost
  std::array<uint32_t, 3> roomFor_{};            ///< of each kind, powers below this have been on the device
};

}  // namespace radar
