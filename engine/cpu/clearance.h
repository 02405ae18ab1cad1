// Finds when a query's sensor comes within its clearance of an object: first, or of each of the nearest objects.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "cpu/approach.h"
#include "cpu/first_contact.h"
#include "scene/scene.h"

namespace radar::cpu {

/// How narrow the bracket of a query with a clearance is to be, world units: Query::tolerance, or by default a share of
/// the longest side of the sensor's box. A larger one would save next to nothing. Without a clearance: 0.
double toleranceOf(const Query& query, const Mesh& sensor);

/// The answer does not depend on the order of the pairs, nor on those that come later than contact by the tolerance.
class ClearanceContact final : public PairVisitor {
 public:
  /// `tolerance`: see toleranceOf. `query` and `motion` must outlive this.
  ClearanceContact(const Query& query, const Motion& motion, double tolerance);

  /// As of FirstContact.
  void beginObject(const PairRule& rule, const Motion& motion) {
    rule_ = rule;
    motion_ = &motion;
  }
  void endObject();
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;
  Result first() const;
  std::vector<Result> nearest() const;

 private:
  struct Near {
    exact::PairName name;
    Approach approach;  ///< its bounds in units of t
    double lo;          ///< nothing considered together with this pair is within the clearance before this

    bool isCertain() const;
    bool precedes(const Near& other) const;
    double latest() const { return approach.hi; }
  };
  std::optional<Approach> approachOf(const exact::PlacedPair& pair) const;
  Result answer(const Near& near) const;

  const Query& query_;
  const Motion* motion_;  // past the current object
  double tolerance_;
  PairRule rule_;
  double lo_;                  // nothing is within the clearance before this
  std::vector<Near> best_;     // at most one: of all objects, or of the current one if several are asked for
  std::vector<Near> nearest_;  // one per object, earliest first
  std::vector<Near> open_;     // of objects that rounding leaves open
};

/// Of what is within a query's clearance at the start, finds the nearest pair, and of equals the least. It passes over
/// the pairs within `reach`, again as long as it can narrow that: those within a large clearance may be very many.
class NearestAtStart final : public PairVisitor {
 public:
  /// `query` must outlive this.
  explicit NearestAtStart(const Query& query) : PairVisitor(0), query_(query), reach_(query.clearance) {}

  /// `motion`: the query's past the next object, which must stay in place meanwhile.
  void beginObject(const PairRule& rule, const Motion& motion) {
    rule_ = rule;
    motion_ = &motion;
  }
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;
  /// Whether the last search past an object has ended early, to go on within less reach.
  bool narrow();
  double reach() const { return reach_; }
  /// Sets ids, features, point, normal and gap.
  void describe(Result& result) const;

 private:
  const Query& query_;
  const Motion* motion_ = nullptr;
  PairRule rule_;
  double reach_;
  exact::PairName name_;
  Separation nearest_{std::numeric_limits<double>::infinity(), {}, {}, {}};
};

}  // namespace radar::cpu
