// Finds when the last contact of a query's sensor ends: the way out of what it overlaps.
#pragma once

#include <optional>

#include "cpu/first_contact.h"
#include "radar/answers.h"

namespace radar::cpu {

/// Visits pairs from the end of the motion back: its t is 0 there.
class LastContact final : public PairVisitor {
 public:
  /// `end`: t of the motion, after which nothing is touched for sure, or its end. `tolerance`: see toleranceOf.
  /// `query` must outlive this.
  LastContact(const Query& query, double end, double tolerance);

  /// As of FirstContact.
  void beginObject(const PairRule&, const Translation& motion) { motion_ = &motion; }
  void endObject() {}
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;
  /// Without its tier.
  Result answer() const;

 private:
  /// The last contact of a pair.
  struct Last {
    double lo, hi;  ///< t; `lo` is -infinity if none is certain
    exact::Features features;
    Vector point, normal;
    double gap = 0;
    std::optional<exact::Event> event{};  ///< if it is exact and before the end
  };
  std::optional<Last> lastOf(const exact::PlacedPair& pair) const;
  std::optional<Last> lastWithin(const exact::PlacedPair& pair) const;
  bool isLater(const Last& last, const exact::PairName& name) const;

  const Query& query_;
  const Translation* motion_ = nullptr;  // past the current object
  double end_, tolerance_;
  double lo_, hi_;  // of all pairs
  exact::PairName name_;
  std::optional<Last> last_;
};

}  // namespace radar::cpu
