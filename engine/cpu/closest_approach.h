// Finds where on its way a query's sensor comes nearest to objects that it does not touch.
#pragma once

#include "cpu/nearest_search.h"
#include "radar/answers.h"

namespace radar::cpu {

class ClosestApproach final : public NearVisitor {
 public:
  ClosestApproach();

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                const PairRule& rule) override;
  bool isBefore(const exact::PairName&) const override { return false; }
  bool leavesTies() const override { return considered_ > kMany; }
  /// t in the units of the motion.
  Closest answer() const;

 private:
  static constexpr uint64_t kMany = 4096;
  uint64_t considered_ = 0;
  Closest closest_;
};

}  // namespace radar::cpu
