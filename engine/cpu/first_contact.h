// Finds a query's contacts among the pairs of triangles that a search passes to it: the first, or the first with each
// of the nearest objects.
#pragma once

#include <utility>
#include <vector>

#include "cpu/pair_visitor.h"
#include "cpu/view.h"
#include "exact/blocking.h"

namespace radar::cpu {

/// How the pairs of a sensor and an object are judged (exact/blocking.h).
struct PairRule {
  double slack = 0;
  exact::Mirrored mirrored;

  bool blocks(const exact::PlacedPair& pair, const Motion& motion) const {
    return exact::blocks(pair.a, pair.b, motion.stands ? Vector{} : motion.direction, slack, mirrored);
  }
  bool arePressed(const exact::PlacedPair& pair, const Motion& motion) const {
    return exact::arePressed(pair.a, pair.b, motion.stands ? Vector{} : motion.direction, slack, mirrored);
  }
};

class FirstContact final : public PairVisitor {
 public:
  /// `sensor`, `size`: the sensor's approximate position and size. `query` and `motion` must outlive this.
  FirstContact(const Query& query, const Motion& motion, const Vector& sensor, double size);

  /// Call before and after the pairs of one object. `rule` matters only if the query ignores pairs that do not block.
  /// `motion` must stay in place meanwhile.
  void beginObject(const PairRule& rule, const Motion& motion);
  void endObject();

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;

  /// The answers, without their tiers: the first contact, or clear; and the contacts with the nearest objects, by (t,
  /// object), if the query asks for more than one.
  Result first() const;
  std::vector<Result> nearest() const;

 private:
  bool considerExactly(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis);
  void limit(const exact::EarliestContact& contact);

  const Query& query_;
  const Motion& sensorMotion_;
  const Motion* motion_;  // past the current object
  const Vector sensor_;
  const double size_;
  View view_;
  PairRule rule_;
  exact::EarliestContact earliest_;              // of all objects, or of the current one if several are asked for
  std::vector<exact::EarliestContact> nearest_;  // one per object, earliest first
};

/// Finds out whether surfaces cross at the start.
class CrossingTest final : public PairVisitor {
 public:
  CrossingTest() : PairVisitor(0) {}

  /// Call before and after the pairs of one object.
  void beginObject(const PairRule& rule, const Motion&) { rule_ = rule; }
  /// Returns whether the surfaces of the sensor and the object cross.
  bool endObject() { return std::exchange(decided_, false); }

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;

 private:
  PairRule rule_;
};

}  // namespace radar::cpu
