// Finds a query's first contact among the pairs of triangles that a search passes to it.
#pragma once

#include "cpu/leaf_test.h"
#include "cpu/view.h"
#include "exact/earliest_contact.h"

namespace radar::cpu {

class FirstContact {
 public:
  /// `anyHit`: any contact suffices. `sensor`, `size`: the sensor's approximate position and size. `motion` must
  /// outlive this.
  FirstContact(const Motion& motion, bool anyHit, const Vector& sensor, double size);

  /// Whether no further pair matters.
  bool isDecided() const { return anyHit_ && earliest_.found(); }
  /// No contact later than this, world units, can be the first.
  double latest() const { return latest_; }
  /// Whether `least` and all pairs after it are ruled out, because a lesser pair meets at the start.
  bool isBefore(const exact::PairName& least) const { return earliest_.overlaps() && earliest_.name() < least; }

  /// Considers a pair of placed triangles that probably meet first along `axis`.
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis);

  /// The answer, without the tier.
  Result result() const { return earliest_.answer(anyHit_); }

 private:
  bool considerExactly(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis);

  const Motion& motion_;
  bool anyHit_;
  View view_;
  exact::EarliestContact earliest_;
  double latest_;
};

}  // namespace radar::cpu
