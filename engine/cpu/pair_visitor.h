// What a search over pairs of triangles serves: finds the pairs that matter and bounds those still wanted.
#pragma once

#include "cpu/leaf_test.h"
#include "exact/earliest_contact.h"

namespace radar::cpu {

class PairVisitor {
 public:
  PairVisitor(const PairVisitor&) = delete;
  PairVisitor& operator=(const PairVisitor&) = delete;

  /// Considers a pair of placed triangles that probably meet first along `axis`.
  virtual void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) = 0;

  /// Whether no further pair matters.
  bool isDecided() const { return decided_; }
  /// No contact later than this t of the motion matters.
  double latest() const { return latest_; }
  /// Whether `least` and all pairs after it are ruled out, because a lesser pair meets at the start.
  bool isBefore(const exact::PairName& least) const { return atStart_ && first_ < least; }

 protected:
  explicit PairVisitor(double latest) : latest_(latest) {}
  ~PairVisitor() = default;

  double latest_;
  bool decided_ = false;
  bool atStart_ = false;   // some pair meets at the start
  exact::PairName first_;  // the least of these
};

}  // namespace radar::cpu
