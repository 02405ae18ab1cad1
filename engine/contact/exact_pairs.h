// Exact decisions on pairs of triangles that double precision cannot decide or order.
#pragma once

#include <compare>

#include "exact/contact.h"
#include "math/frame.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// 2^-53.
inline constexpr double kDoubleUnit = 0x1p-53;

/// A pair. Of equal contacts the least wins.
struct PairName {
  ObjectId object;
  uint32_t triB, triA;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the zero compared with for a pointer
  friend auto operator<=>(const PairName&, const PairName&) = default;
};

/// The sensor's triangle and the scene's, placed; corners sorted, in the device's numbering.
struct PlacedPair {
  exact::Triangle a, b;
};
PlacedPair placedPair(const PairName& name, const Query& query, const Scene::Impl& scene);
PlacedPair placedPair(const gpu::UnresolvedPair& pair, const Query& query);

/// Sets t, its bracket t -+ slack, clipped to [0, D], and the fraction.
void setBracket(Result& result, double t, double slack, double distance);

/// Finds the first contact among the pairs considered.
class ExactPairs {
 public:
  explicit ExactPairs(const Query& query) : direction_(scaledDirection(query.direction)), distance_(query.distance) {}

  void consider(const PairName& name, const PlacedPair& pair);
  bool found() const { return found_; }
  /// Sets everything but the tier, from the first contact found.
  void tell(Result& result) const;

 private:
  struct Decided {
    PairName name;
    PlacedPair pair;
    exact::Event first;
    bool overlap;  // at or before the start
  };
  static bool earlier(const Decided& p, const Decided& q);

  Vector direction_;
  double distance_;
  bool found_ = false;
  Decided best_{};
};

}  // namespace radar
