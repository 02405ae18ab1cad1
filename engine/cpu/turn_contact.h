// Finds when a sensor that turns first touches an object, or comes within its clearance.
#pragma once

#include "cpu/path_contact.h"
#include "cpu/turn_motion.h"

namespace radar::cpu {

class TurnContact final : public PathContact {
 public:
  /// All outlive this.
  TurnContact(const Query& query, const TurnMotion& motion, double tolerance)
      : PathContact(query), motion_(motion), tolerance_(tolerance) {}

  /// Before the pairs of an object, which moves by `way` during the step. `rule`: as of FirstContact.
  void beginObject(const PairRule& rule, const Vector& way) {
    rule_ = rule;
    drift_ = way;
    setTolerance(tolerance_, motion_.speedPast(way));
  }

 private:
  class Path;
  std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) override;

  const TurnMotion& motion_;
  double tolerance_;
  Vector drift_{};  // of the object
  PairRule rule_;
};

}  // namespace radar::cpu
