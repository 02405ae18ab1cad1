// Finds when a sensor that turns first touches an object, or comes within its clearance.
#pragma once

#include "cpu/bracketed_contact.h"
#include "cpu/turn_motion.h"

namespace radar::cpu {

/// World units: how narrow brackets are to be, times the greatest speed (Query::tolerance).
double turnToleranceOf(const Query& query, const Mesh& sensor, const TurnMotion& motion);

/// Of two triangles, one of which turns past the other: brackets of s.
class TurnContact final : public BracketedContact {
 public:
  /// All outlive this.
  TurnContact(const Query& query, const TurnMotion& motion, double tolerance);

  /// Before the pairs of an object, which moves by `way` during the step, and stays in place until the next one.
  void beginObject(const Vector& way);
  /// Of the pairs considered next: they are known not to meet before `from`, and are of no interest after `to`.
  void setTimes(double from, double to) {
    from_ = from;
    to_ = to;
  }

 private:
  class Pair;
  std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) override;
  bool counts(const exact::PlacedPair&) const override { return true; }

  const TurnMotion& motion_;
  double tolerance_;
  Vector drift_{};   // of the object
  double fine_ = 1;  // s in which the sensor moves by the tolerance
  double from_ = 0, to_ = 1;
};

}  // namespace radar::cpu
