// Finds when a query's sensor comes within its clearance of an object: first, or of each of the nearest objects.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "cpu/bracketed_contact.h"
#include "cpu/nearest_search.h"
#include "scene/scene.h"

namespace radar::cpu {

/// How narrow the bracket of a query with a clearance is to be, world units: Query::tolerance, at most a share of the
/// longest side of the sensor's box, or of the clearance if that is longer; larger ones would save next to nothing. By
/// default the share of the side. Without a clearance: 0.
double toleranceOf(const Query& query, const Mesh& sensor);

/// Contact is to come as near as the clearance.
class ClearanceContact final : public BracketedContact {
 public:
  /// `tolerance`: see toleranceOf. `query` and `motion` must outlive this.
  ClearanceContact(const Query& query, const Translation& motion, double tolerance);

  /// As of FirstContact.
  void beginObject(const PairRule& rule, const Translation& motion) {
    rule_ = rule;
    motion_ = &motion;
    if (query_.ignoreLeaving) lead_ = rule.leadOf(motion);
  }

 private:
  std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) override;
  bool counts(const exact::PlacedPair& pair) const override;
  /// `across`: of cpu::approach.
  std::optional<Approach> approachOf(const exact::PlacedPair& pair, Vector* across) const;
  /// Whether faces that are pressed together touch at the start, though rounding may have let them pass each other by
  /// the slack, and so by more than the clearance.
  bool hasSunkIn(const exact::PlacedPair& pair) const;

  const Translation* motion_;  // past the current object
  double tolerance_;           // world units
  PairRule rule_;
};

/// Of what is within a query's clearance at the start, finds the nearest pair, and of equals the least.
class NearestAtStart final : public NearVisitor {
 public:
  /// `query` must outlive this.
  explicit NearestAtStart(const Query& query) : NearVisitor((1 + 0x1p-20) * query.clearance), query_(query) {}

  /// Call before an object is added to the search.
  void allowFor(const PairRule& rule) {
    // What is pressed together may have sunk in.
    if (query_.ignoreLeaving && name_.object == kNone) reach_ = std::max(reach_, 2 * rule.slack);
  }
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                const PairRule& rule) override;
  bool isBefore(const exact::PairName& least) const override { return nearest_.distance == 0 && name_ < least; }
  /// Sets ids, features, point, normal and gap.
  void describe(Result& result) const;

 private:
  const Query& query_;
  exact::PairName name_;
  Separation nearest_{std::numeric_limits<double>::infinity(), {}, {}, {}};
};

}  // namespace radar::cpu
