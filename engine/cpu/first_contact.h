// The first contact of a query, found among the pairs of triangles that a search shows it.
#pragma once

#include <compare>

#include "cpu/leaf_test.h"
#include "cpu/view.h"

namespace radar::cpu {

/// A pair of triangles, in the order in which ties go.
struct PairName {
  ObjectId object = kNone;
  uint32_t triB = kNone, triA = kNone;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the zero compared with for a pointer
  friend auto operator<=>(const PairName&, const PairName&) = default;
};

class FirstContact {
 public:
  /// `decide`: any contact will do. `sensor`, `size`: where it is and how large, roughly. `motion` must
  /// outlive this.
  FirstContact(const Motion& motion, bool decide, const Vector& sensor, double size);

  /// Whether nothing more need be shown.
  bool isDecided() const { return decide_ && found_; }
  /// Nothing that is met later than this, world units, can be the first contact.
  double latest() const { return latest_; }
  /// Whether neither `least` nor any pair behind it can be: the surfaces meet at the start, by a lesser pair.
  bool isBefore(const PairName& least) const { return overlap_ && name_ < least; }

  /// Looks at a pair of placed triangles that probably meet first across `axis`.
  void consider(const PairName& name, const exact::Triangle& a, const exact::Triangle& b, Axis axis);

  /// Everything but the tier.
  Result result() const;

 private:
  void keep(const PairName& name, const exact::Triangle& a, const exact::Triangle& b, const exact::Event& first,
            bool overlap);
  void setBracket(Result& result, double t) const;

  const Motion& motion_;
  View view_;
  bool decide_;
  bool found_ = false;
  bool overlap_ = false;  // t* = 0
  PairName name_;
  exact::Event event_{};       // where contact of the pair begins
  exact::Triangle a_{}, b_{};  // the pair
  double latest_;
};

}  // namespace radar::cpu
