// How near two triangles come to each other on a way.
#include <algorithm>

#include "cpu/moments.h"

namespace radar::cpu {

namespace {

using namespace moments;

// Steps converge quadratically.
constexpr int kMostSteps = 200;

/// Bounds on the least distance of a pair on its way.
template <class Real>
struct Least {
  Real lo{}, hi{Of<Real>::never};
  Real way{};  ///< where it is at most `hi`
  Moment<Real> at;
};

/// None if it certainly is more than the clearance.
template <class Real>
std::optional<Least<Real>> leastOf(const Pair<Real>& pair) {
  struct Side {
    Real t;
    Moment<Real> moment;
  };
  Least<Real> found;
  exact::FeaturePlace place = exact::kAnyPlace;
  const auto sideAt = [&](const Real& t) {
    Side side{t, momentAt(pair, t, place)};
    place = side.moment.nearest.place;
    if (side.moment.most < found.hi) {
      found.hi = side.moment.most;
      found.way = t;
      found.at = side.moment;
    }
    return side;
  };
  // How fast the distance may fall at most, from a side's moment on and from it back: it is convex.
  const auto onwards = [](const Side& side) { return side.moment.rate + kRateError<Real>; };
  const auto backwards = [](const Side& side) { return kRateError<Real> - side.moment.rate; };
  const auto isNear = [&] { return found.lo <= pair.clearance ? std::optional(found) : std::nullopt; };

  Side left = sideAt(Real{});
  found.lo = left.moment.least;
  if (!(onwards(left) > Real{})) return isNear();
  found.lo = left.moment.least - onwards(left) * pair.distance - left.moment.error;
  if (found.lo > pair.clearance) return std::nullopt;
  Side right = sideAt(pair.distance);
  found.lo = right.moment.least;
  if (!(backwards(right) > Real{})) return isNear();
  for (int i = 0; i < kMostSteps; ++i) {
    // Between the sides the distance is above the lines that these give.
    const Real width = right.t - left.t, fall = onwards(left), rise = backwards(right);
    const Real &atLeft = left.moment.least, &atRight = right.moment.least;
    const Real meet = std::clamp((atLeft - atRight + rise * width) / (fall + rise), Real{}, width);
    const Real lines = std::min(atLeft - fall * meet, atRight - rise * (width - meet)) - left.moment.error;
    found.lo = std::max(lines, Real{});
    if (found.lo > pair.clearance) return std::nullopt;
    if (found.hi - found.lo <= Real{4} * left.moment.error) break;
    // Its square is one of t while the nearest features stay the same.
    const Real before = left.moment.rate * left.moment.most, after = Real{} - right.moment.rate * right.moment.most;
    const bool isSecant = i % 2 == 0 && before > Real{} && after > Real{};
    const Real t = left.t + (isSecant ? before / (before + after) * width : meet);
    if (!(left.t < t && t < right.t)) break;
    Side next = sideAt(t);
    const bool falls = next.moment.rate > kRateError<Real>, rises = next.moment.rate < Real{} - kRateError<Real>;
    if (falls) left = next;
    if (rises) right = next;
    if (falls || rises) continue;
    // Level, as far as rounding tells. Sides near it keep what that may hide small.
    for (Real off = Real{0x1p-10} * next.moment.most; off < width; off = Real{64} * off) {
      const Real on = t + off, back = t - off;
      if (on < right.t) {
        if (const Side side = sideAt(on); side.moment.rate < Real{} - kRateError<Real>) right = side;
      }
      if (left.t < back) {
        if (const Side side = sideAt(back); side.moment.rate > kRateError<Real>) left = side;
      }
      if (!(on < right.t) && !(left.t < back)) break;
    }
    const Real hidden = std::max(onwards(next) * (right.t - t), backwards(next) * (t - left.t));
    const Real level = std::min({next.moment.least - hidden - next.moment.error, atLeft, atRight});
    found.lo = std::max(found.lo, level);
    break;
  }
  return isNear();
}

}  // namespace

std::optional<Passage> passage(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                               double reach) {
  const int exponent = exponentOf(a, b, 0);
  const double scale = std::ldexp(1.0, -exponent), unscale = std::ldexp(1.0, exponent);
  Pair<double> rough = roughPair(a, b, motion, std::min(reach, unscale * kPast), 0, scale);
  rough.distance = std::min(rough.distance, kPast);
  const auto inWay = [&]<class Real>(const Least<Real>& found, const Point<Real>& unit) {
    return Passage{unscaledDown(roundedDown(found.lo), unscale), unscaledUp(roundedUp(found.hi), unscale),
                   std::min(unscale * Of<Real>::rounded(found.way), motion.wayUntil(motion.end)),
                   inWorld(found.at, found.way, a, b, unit, unscale)};
  };
  const auto found = leastOf(rough);
  if (!found) return std::nullopt;
  if (found->hi - found->lo <= kFine * found->hi) return inWay(*found, motion.unit);
  const Pair<DoubleDouble> fine = finePair(rough, a, b, motion, scale);
  const auto better = leastOf(fine);
  return better ? std::optional(inWay(*better, fine.unit)) : std::nullopt;
}

}  // namespace radar::cpu
