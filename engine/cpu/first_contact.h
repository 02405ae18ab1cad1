// Finds a query's first contact among the pairs of triangles that a search passes to it.
#pragma once

#include <compare>

#include "cpu/leaf_test.h"
#include "cpu/view.h"

namespace radar::cpu {

/// A pair of triangles. Of equal contacts the least wins.
struct PairName {
  ObjectId object = kNone;
  uint32_t triB = kNone, triA = kNone;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the zero compared with for a pointer
  friend auto operator<=>(const PairName&, const PairName&) = default;
};

class FirstContact {
 public:
  /// `anyHit`: any contact suffices. `sensor`, `size`: the sensor's approximate position and size. `motion` must
  /// outlive this.
  FirstContact(const Motion& motion, bool anyHit, const Vector& sensor, double size);

  /// Whether no further pair matters.
  bool isDecided() const { return anyHit_ && found_; }
  /// No contact later than this, world units, can be the first.
  double latest() const { return latest_; }
  /// Whether `least` and all pairs after it are ruled out, because a lesser pair meets at the start.
  bool isBefore(const PairName& least) const { return overlap_ && name_ < least; }

  /// Considers a pair of placed triangles that probably meet first along `axis`.
  void consider(const PairName& name, const exact::Triangle& a, const exact::Triangle& b, Axis axis);

  /// The answer, without the tier.
  Result result() const;

 private:
  void keep(const PairName& name, const exact::Triangle& a, const exact::Triangle& b, const exact::Event& first,
            bool overlap);
  void setBracket(Result& result, double t) const;

  const Motion& motion_;
  View view_;
  bool anyHit_;
  bool found_ = false;
  bool overlap_ = false;  // t* = 0
  PairName name_;
  exact::Event event_{};       // where contact of the pair begins
  exact::Triangle a_{}, b_{};  // the pair
  double latest_;
};

}  // namespace radar::cpu
