#include "cpu/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu/moments.h"

namespace radar::cpu {

namespace {

using namespace moments;

// Steps converge quadratically, or by a factor of two where the triangles pass each other just within the clearance.
constexpr int kMostSteps = 200, kNarrowSteps = 8;

/// When a pair comes within the clearance, in the units of the pair.
template <class Real>
struct Found {
  Real lo{}, hi{Of<Real>::never};
  std::optional<Moment<Real>> atLo;  ///< if `hi` is known
  bool isRough = false;              ///< more digits may help
};

template <class Real>
void setAcross(const Moment<Real>& m, Vector* across) {
  const Vector gap = rounded(m.nearest.a - m.nearest.b);
  if (across != nullptr && largest(gap) > 0x1p-500) *across = scaled(1 / largest(gap), gap);
}

/// Whether the pair certainly does not come within the clearance before `t`: then a plane keeps them farther apart that
/// the motion goes against.
bool comesLater(const Pair<double>& pair, double t, Vector* across) {
  const Moment<double> m = momentAt(pair, t);
  if (!(m.least > pair.clearance && m.rate > kRateError<double>)) return false;
  setAcross(m, across);
  return true;
}

template <class Real>
std::optional<Found<Real>> search(const Pair<Real>& pair, Vector* across = nullptr) {
  constexpr Real kNever{Of<Real>::never}, kHalf{0.5};
  const Real& clearance = pair.clearance;
  Found<Real> found;
  // The distance is convex in t. So contact fills one interval, which lies between found.lo and `end`.
  Real t{}, end = kNever, step{}, approaching{}, receding = kNever;
  exact::FeaturePlace place = exact::kAnyPlace;
  for (int i = 0; i < kMostSteps; ++i) {
    const Moment<Real> m = momentAt(pair, t, place);
    place = m.nearest.place;
    // Most brackets can be as narrow as rounding allows.
    const Real least = std::max(i < kNarrowSteps ? Real{} : kHalf * pair.tolerance, Real{4} * m.error);
    if (m.most <= clearance) {
      found.hi = t;
      found.atLo = t > Real{} ? momentAt(pair, found.lo, place) : m;
      return found;
    }
    if (m.least > clearance) {
      // No contact while the plane, which moves at a constant rate, is farther than the clearance.
      const Real spare = (m.least - clearance) * (Real{1} - Real{16 * Of<Real>::unit}),
                 forward = m.rate + kRateError<Real>, backward = kRateError<Real> - m.rate;
      const Real from = backward > Real{} ? t - spare / backward : -kNever;
      const Real to = forward > Real{} ? t + spare / forward : kNever;
      if (from <= found.lo) {
        found.lo = std::max(found.lo, to * (Real{1} - Real{4 * Of<Real>::unit}));
      } else if (to >= end || to >= kNever) {
        end = std::min(end, from * (Real{1} + Real{4 * Of<Real>::unit}));
      } else {
        return found;
      }
      if (found.lo > pair.distance || found.lo >= end) {
        setAcross(m, across);
        return std::nullopt;
      }
      step = least;
      const Real next = std::min({found.lo + step, kHalf * found.lo + kHalf * end, pair.distance});
      // A motion along the plane leaves no room for another step.
      if (next == t) return found;
      t = next;
    } else {
      // Rounding leaves open whether the triangles are within the clearance now. They are nearest to each other between
      // where they still approach and where they move apart.
      found.isRough = found.isRough || m.error > Real{kFine} * clearance || m.most - m.least > Real{kTight} * m.error;
      const bool isApproaching = m.rate + kRateError<Real> > Real{};
      if (isApproaching) approaching = std::max(approaching, t);
      if (!isApproaching) receding = std::min(receding, t);
      const Real from = std::max(found.lo, approaching), to = std::min(end, receding);
      step = std::max(Real{8} * step, least);
      const Real next =
          isApproaching ? std::min({t + step, kHalf * t + kHalf * to, pair.distance}) : kHalf * from + kHalf * t;
      if (next == t || !(to - from > m.error)) return found;
      t = next;
    }
  }
  return found;
}

template <class Real>
Approach inWorld(const Found<Real>& found, const exact::Triangle& a, const exact::Triangle& b, const Point<Real>& unit,
                 double unscale) {
  Approach out{unscaledDown(roundedDown(found.lo), unscale), unscaledUp(roundedUp(found.hi), unscale), {}};
  if (found.atLo) out.atLo = inWorld(*found.atLo, found.lo, a, b, unit, unscale);
  return out;
}

/// The same motion from its end back.
template <class Real>
Pair<Real> reversed(Pair<Real> pair) {
  pair.size = Of<Real>::rounded(pair.distance);
  for (const Point<Real>& gap : pair.gaps) pair.size = std::max(pair.size, norm1(gap));
  for (Point<Real>& gap : pair.gaps) gap = gap - pair.distance * pair.unit;
  pair.unit = Real{-1} * pair.unit;
  return pair;
}

template <class Real>
Nearing nearingOf(Pair<Real> pair, double slack) {
  const Moment<Real> start = momentAt(pair, Real{});
  if (start.most <= Real{slack}) return Nearing::pressed;
  if (start.least <= Real{slack}) return Nearing::open;
  // The distance is convex: what does not come nearer at the start never does. The nearest points' difference is that
  // of the least length among all, and theirs is at most `most`: the two differ by at most `off`.
  const Real off = Of<Real>::root((start.most - start.least) * (start.most + start.least));
  if (start.least * start.rate + Real{4} * off < Real{}) return Nearing::no;
  // Bounds on the distance that they would have to come nearer than.
  constexpr Real kMargin{16 * Of<Real>::unit};
  const Real low = (std::min(start.least, pair.clearance) - Real{slack}) * (Real{1} - kMargin) - start.error;
  const Real high = (std::min(start.most, pair.clearance) - Real{slack}) * (Real{1} + kMargin);
  // It falls no faster than that of the plane, and no longer than until a is ahead of b by as much as at the start.
  Real behind{};
  for (const Point<Real>& a : pair.edges) {
    for (const Point<Real>& b : pair.gaps) behind = std::max(behind, dot(pair.unit, b - a));
  }
  const Real rate = std::max(start.rate + kRateError<Real>, Real{});
  const Real floor = start.least - Real{1 + 0x1p-20} * rate * (behind + start.most + start.error);
  if (floor > high) return Nearing::no;
  // Rounding leaves open the rest.
  if (floor > low) return Nearing::open;
  pair.clearance = low;
  pair.tolerance = Real{0x1p-6} * low;
  if (low > Real{}) {
    const auto found = search(pair);
    if (found) return found->hi < Real{Of<Real>::never} ? Nearing::yes : Nearing::open;
  }
  pair.clearance = high + start.error;
  return search(pair) ? Nearing::open : Nearing::no;
}

}  // namespace

Separation separationOf(const exact::Triangle& a, const exact::Triangle& b) {
  const int exponent = exponentOf(a, b, 0);
  const double scale = std::ldexp(1.0, -exponent);
  const Pair<double> pair{relative<double>(a, a[0], scale), relative<double>(b, a[0], scale), {}, 0, 0, 0};
  const Moment<double> moment = momentAt(pair, 0.0);
  Separation out = inWorld(moment, 0.0, a, b, pair.unit, std::ldexp(1.0, exponent));
  if (moment.least > 0) return out;
  const auto meets = exact::contact(a, b, {1, 0, 0});
  if (!meets || exact::sign(meets->first) > 0 || exact::sign(meets->last) < 0) return out;
  out.distance = 0;
  out.normal.fill(kNan);
  return out;
}

bool stayApart(const exact::Triangle& a, const exact::Triangle& b, const Vector& normal, const Vector& displacement,
               double clearance) {
  double low = 0, high = -std::numeric_limits<double>::infinity(), size = radar::norm1(displacement);
  for (size_t i = 0; i < 3; ++i) {
    const Vector ofA = a[i] - a[0], ofB = b[i] - a[0];
    low = std::min(low, radar::dot(normal, ofA));
    high = std::max(high, radar::dot(normal, ofB));
    size = std::max({size, radar::norm1(ofA), radar::norm1(ofB)});
  }
  const double gap = low + std::min(radar::dot(normal, displacement), 0.0) - high;
  return gap > (1 + 0x1p-20) * std::sqrt(radar::dot(normal, normal)) * clearance + 64 * kUnit * size;
}

std::optional<Approach> approach(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                                 double clearance, double tolerance, double latest, Vector* across) {
  const double distance = motion.wayUntil(motion.end);
  const int exponent = exponentOf(a, b, clearance);
  const double scale = std::ldexp(1.0, -exponent), unscale = std::ldexp(1.0, exponent);
  const Pair<double> rough = roughPair(a, b, motion, clearance, tolerance, scale);
  // A trial at the end may come out a little later, by the rounding of its bound.
  const auto withinWay = [&](Approach out) {
    if (!std::isinf(out.hi)) out.hi = std::min(out.hi, distance);
    return out;
  };
  if (comesLater(rough, scale * motion.wayUntil(latest), across)) return std::nullopt;
  const auto found = search(rough, across);
  if (!found) return std::nullopt;
  if (!found->isRough || found->hi - found->lo <= rough.tolerance)
    return withinWay(inWorld(*found, a, b, motion.unit, unscale));
  const Pair<DoubleDouble> fine = finePair(rough, a, b, motion, scale);
  const auto better = search(fine);
  return better ? std::optional(withinWay(inWorld(*better, a, b, fine.unit, unscale))) : std::nullopt;
}

std::optional<Approach> leaving(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                                double clearance, double tolerance) {
  const int exponent = exponentOf(a, b, clearance);
  const double scale = std::ldexp(1.0, -exponent), unscale = std::ldexp(1.0, exponent);
  Pair<double> rough = roughPair(a, b, motion, clearance, tolerance, scale);
  const bool goesPast = rough.distance > kPast;
  rough.distance = std::min(rough.distance, kPast);
  // From the end back.
  const double distance = motion.wayUntil(motion.end);
  const auto inTime = [&]<class Real>(const Found<Real>& found, const Point<Real>& unit, const Real& end) {
    const double last = unscaledUp(roundedUp(Real{1 + 4 * kUnit} * (end - found.lo)), unscale);
    const double hi = std::min(last, distance);
    if (!(found.hi < Real{Of<Real>::never})) return Approach{-std::numeric_limits<double>::infinity(), hi, {}};
    if (found.hi == Real{} && !goesPast) {
      return Approach{distance, distance, inWorld(*found.atLo, end, a, b, unit, unscale)};
    }
    return Approach{unscaledDown(std::max(roundedDown(Real{1 - 4 * kUnit} * (end - found.hi)), 0.0), unscale), hi,
                    inWorld(*found.atLo, end - found.lo, a, b, unit, unscale)};
  };
  const Pair<double> back = reversed(rough);
  const auto found = search(back);
  if (!found) return std::nullopt;
  if (!found->isRough || found->hi - found->lo <= rough.tolerance) return inTime(*found, motion.unit, rough.distance);
  const Pair<DoubleDouble> fine = finePair(rough, a, b, motion, scale);
  const auto better = search(reversed(fine));
  return better ? std::optional(inTime(*better, fine.unit, fine.distance)) : std::nullopt;
}

Nearing nearingOf(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction, double clearance,
                  double slack) {
  const int exponent = exponentOf(a, b, clearance);
  if (clearance <= slack) return Nearing::pressed;
  if (std::abs(exponent) > 900) return Nearing::open;
  const double scale = std::ldexp(1.0, -exponent);
  const Point<DoubleDouble> unit = normalised(direction);
  const Pair<double> rough{
      relative<double>(a, a[0], scale), relative<double>(b, a[0], scale), rounded(unit), scale * clearance, kPast, 0};
  const Nearing found = nearingOf(rough, scale * slack);
  if (found != Nearing::open) return found;
  const Pair<DoubleDouble> fine{relative<DoubleDouble>(a, a[0], scale),
                                relative<DoubleDouble>(b, a[0], scale),
                                unit,
                                {rough.clearance},
                                {kPast},
                                {}};
  return nearingOf(fine, scale * slack);
}

bool staysLevel(const exact::Triangle& a, const exact::Triangle& b, const Vector& unit, double slack) {
  double gap = 0, size = 0, lowA = 0, highB = -std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const auto [fromA, toA] = std::minmax({a[0][k], a[1][k], a[2][k]});
    const auto [fromB, toB] = std::minmax({b[0][k], b[1][k], b[2][k]});
    gap = std::max({gap, fromA - toB, fromB - toA});
  }
  if (!(gap > (1 + 2 * kUnit) * slack)) return false;
  for (size_t i = 0; i < 3; ++i) {
    const Vector ofA = a[i] - a[0], ofB = b[i] - a[0];
    lowA = std::min(lowA, radar::dot(unit, ofA));
    highB = std::max(highB, radar::dot(unit, ofB));
    size = std::max({size, radar::norm1(ofA), radar::norm1(ofB)});
  }
  // Of points that are s apart, a's behind by h, the distance after t is the root of at least s^2 - 2 t h + t^2.
  const double behind = std::max(highB - lowA, 0.0) + 32 * kUnit * size;
  return behind * behind < (1 - 0x1p-20) * gap * slack;
}

bool certainlyWithin(const exact::Triangle& a, const exact::Triangle& b, const Vector& displacement, double clearance) {
  const int exponent = exponentOf(a, b, std::max(clearance, radar::norm1(displacement)));
  const double scale = std::ldexp(1.0, -exponent);
  Pair<DoubleDouble> pair{
      relative<DoubleDouble>(a, a[0], scale), relative<DoubleDouble>(b, a[0], scale), {}, {}, {}, {}};
  for (Point<DoubleDouble>& corner : pair.gaps) corner = corner - exactly<DoubleDouble>(scaled(scale, displacement));
  return momentAt(pair, DoubleDouble{}).most <= DoubleDouble{scale * clearance};
}

}  // namespace radar::cpu
