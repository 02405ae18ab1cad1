#include "cpu/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/double_double.h"
#include "exact/nearest_points.h"

namespace radar::cpu {

namespace {

using exact::Corners, exact::DoubleDouble, exact::dot, exact::Nearest, exact::nearestPoints, exact::Point;
using exact::operator+, exact::operator-, exact::operator*;

// Steps converge quadratically, or by a factor of two where the triangles pass each other just within the clearance.
constexpr int kMostSteps = 200, kNarrowSteps = 8;
// More digits may tell whether triangles are within the clearance if less of it than this is known: of positions, as
// those of triangles a million times as large. Likewise if the bounds on the distance differ by more of the positions'
// error than this: the nearest points are those of the least square, which tells them to some 2^-26 only, or those of
// needles, which are not found.
constexpr double kFine = 0x1p-27, kTight = 16;

/// What the search needs of a number. It is written once, for doubles and for double-doubles.
template <class Real>
struct Of;
template <>
struct Of<double> {
  static constexpr double unit = kUnit;  ///< a sum, product, quotient or root is off by at most this
  static constexpr double never = std::numeric_limits<double>::infinity();
  static double root(double x) { return std::sqrt(x); }
  static double rounded(double x) { return x; }
};
template <>
struct Of<DoubleDouble> {
  static constexpr double unit = 0x1p-102;
  static constexpr double never = 1e300;  // infinity would not survive their sums
  static DoubleDouble root(const DoubleDouble& x) { return exact::root(x); }
  static double rounded(const DoubleDouble& x) { return x.high; }
};

template <class Real>
Vector rounded(const Point<Real>& p) {
  return {Of<Real>::rounded(p[0]), Of<Real>::rounded(p[1]), Of<Real>::rounded(p[2])};
}
template <class Real>
double norm1(const Point<Real>& p) {
  return radar::norm1(rounded(p));
}
template <class Real>
Point<Real> exactly(const Vector& v) {
  return {Real{v[0]}, Real{v[1]}, Real{v[2]}};
}

/// The triangles at one moment.
template <class Real>
struct Moment {
  Nearest<Real> nearest;  // relative to corner 0 of the moving triangle
  Real least, most;       // bounds on their distance
  Real rate;              // of a bound that `least` gives on all distances: the decrease per unit of motion
  Real error;             // of positions
};

/// Two triangles, relative to corner 0 of the moving one and scaled by a power of two, and how they are to meet.
template <class Real>
struct Pair {
  Corners<Real> edges, gaps;  ///< the moving one; the resting one
  Point<Real> unit;
  Real clearance, distance, tolerance;
  double size = 0;  ///< the greatest of the numbers that the others come from
};

// Lengths are at most 2 but for the way: triangles that have moved farther than this move apart, and are apart by more
// than a clearance.
constexpr double kPast = 8;

/// `first`: where the nearest points may be.
template <class Real>
Moment<Real> momentAt(const Pair<Real>& pair, const Real& t, exact::FeaturePlace first = exact::kAnyPlace) {
  const Corners<Real>&edges = pair.edges, &gaps = pair.gaps;
  const Point<Real>& unit = pair.unit;
  Moment<Real> m;
  Corners<Real> b;
  for (size_t k = 0; k < 3; ++k) b[k] = gaps[k] - t * unit;
  // Differences, the motion and its direction lose less than 16u of these numbers; the nearest points, whatever their
  // weights, and inner products with a unit vector less than 16u more.
  double size = std::max(Of<Real>::rounded(t), pair.size);
  for (size_t k = 0; k < 3; ++k) size = std::max({size, norm1(gaps[k]), norm1(b[k]), norm1(edges[k])});
  m.error = Real{64 * Of<Real>::unit * size + std::numeric_limits<double>::min()};
  m.nearest = nearestPoints(edges, b, Real{0.5} * m.error, first);
  const Point<Real> gap = m.nearest.b - m.nearest.a;
  const Real length = Of<Real>::root(dot(gap, gap));
  m.most = length + m.error;
  m.least = Real{};
  m.rate = Real{1};
  if (!(length > Real{} && length < Real{Of<Real>::never})) return m;
  // A plane across the line between the nearest points keeps the triangles apart, now and until the motion has used up
  // its distance.
  const Point<Real> n = (Real{1} / length) * gap;
  const Real from = std::max({dot(n, edges[0]), dot(n, edges[1]), dot(n, edges[2])});
  const Real to = std::min({dot(n, b[0]), dot(n, b[1]), dot(n, b[2])});
  m.least = std::max(to - from - m.error, Real{});
  m.rate = dot(n, unit);
  return m;
}

/// When a pair comes within the clearance, in the units of the pair.
template <class Real>
struct Found {
  Real lo{}, hi{Of<Real>::never};
  std::optional<Moment<Real>> atLo;  ///< if `hi` is known
  bool isRough = false;              ///< more digits may help
};

/// Of a rate: of two unit vectors and their inner product.
template <class Real>
inline constexpr Real kRateError{64 * Of<Real>::unit};

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

double difference(double p, double q, double) {
  return p - q;
}
DoubleDouble difference(double p, double q, const DoubleDouble&) {
  return exact::difference(p, q);
}

/// A triangle relative to a point.
template <class Real>
Corners<Real> relative(const exact::Triangle& triangle, const Vector& origin, double scale) {
  Corners<Real> out;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) out[i][k] = Real{scale} * difference(triangle[i][k], origin[k], Real{});
  }
  return out;
}

/// A direction of length 1.
Point<DoubleDouble> normalised(const Vector& direction) {
  const int exponent = std::ilogb(largest(direction));
  Point<DoubleDouble> d;
  for (size_t k = 0; k < 3; ++k) d[k].high = std::ldexp(direction[k], -exponent);
  return (DoubleDouble{1} / exact::root(dot(d, d))) * d;
}

/// Outwards.
double roundedDown(double x) {
  return x;
}
double roundedUp(double x) {
  return x;
}
double roundedDown(const DoubleDouble& x) {
  return (1 - 2 * kUnit) * x.high;
}
double roundedUp(const DoubleDouble& x) {
  return x.high < Of<DoubleDouble>::never ? (1 + 2 * kUnit) * x.high : std::numeric_limits<double>::infinity();
}

/// Times a power of two, outwards where that rounds.
double unscaledDown(double x, double unscale) {
  const double out = unscale * x;
  return x > 0 && out < std::numeric_limits<double>::min()
             ? std::max(out - std::numeric_limits<double>::denorm_min(), 0.0)
             : out;
}
double unscaledUp(double x, double unscale) {
  const double out = unscale * x;
  return x > 0 && out < std::numeric_limits<double>::min() ? out + std::numeric_limits<double>::denorm_min() : out;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Of triangle a, moved by `way` along the unit vector, and b.
template <class Real>
Separation inWorld(const Moment<Real>& moment, const Real& way, const exact::Triangle& a, const exact::Triangle& b,
                   const Point<Real>& unit, double unscale) {
  const Nearest<Real>& nearest = moment.nearest;
  const Point<Real> gap = nearest.a - nearest.b;
  const Real length = Of<Real>::root(dot(gap, gap));
  Separation out{unscale * Of<Real>::rounded(length), {}, {kNan, kNan, kNan}, nearest.features};
  if (nearest.features.b == Feature::vertex) {
    out.point = b[nearest.corner];
  } else {
    out.point = rounded(exactly<Real>(a[0]) + Real{unscale} * way * unit + Real{unscale} * nearest.b);
  }
  // The points tell, even where a plane across the line between them, tilted by rounding, no longer keeps apart all.
  if (length > moment.error) out.normal = rounded((Real{1} / length) * gap);
  return out;
}

template <class Real>
Approach inWorld(const Found<Real>& found, const exact::Triangle& a, const exact::Triangle& b, const Point<Real>& unit,
                 double unscale) {
  Approach out{unscaledDown(roundedDown(found.lo), unscale), unscaledUp(roundedUp(found.hi), unscale), {}};
  if (found.atLo) out.atLo = inWorld(*found.atLo, found.lo, a, b, unit, unscale);
  return out;
}

/// Exponent of a power of two that scales lengths up to about `size` to 1, so that products neither overflow nor
/// underflow.
int exponentOf(const exact::Triangle& a, const exact::Triangle& b, double size) {
  for (size_t i = 0; i < 3; ++i) size = std::max({size, norm1(a[i] - a[0]), norm1(b[i] - a[0])});
  return std::clamp(std::ilogb(size), -1000, 1000);
}

Pair<double> roughPair(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion, double clearance,
                       double tolerance, double scale) {
  return {relative<double>(a, a[0], scale),
          relative<double>(b, a[0], scale),
          motion.unit,
          scale * clearance,
          scale * motion.wayUntil(motion.end),
          scale * tolerance};
}

/// How far a step goes, scaled and rounded up. A double is above it by more than double-doubles lose.
DoubleDouble wayOf(const Vector& displacement, double scale) {
  const int exponent = std::ilogb(largest(displacement));
  Point<DoubleDouble> d;
  for (size_t k = 0; k < 3; ++k) d[k].high = std::ldexp(displacement[k], -exponent);
  const DoubleDouble length = DoubleDouble{1, 0x1p-99} * exact::root(dot(d, d));
  const double unscale = scale * std::ldexp(1.0, exponent);
  return {unscale * length.high, unscale * length.low};
}

Pair<DoubleDouble> finePair(const Pair<double>& rough, const exact::Triangle& a, const exact::Triangle& b,
                            const Translation& motion, double scale) {
  DoubleDouble distance{std::min(rough.distance, 1e290)};
  if (motion.isStep) distance = motion.stands ? DoubleDouble{} : std::min(distance, wayOf(motion.direction, scale));
  return {relative<DoubleDouble>(a, a[0], scale),
          relative<DoubleDouble>(b, a[0], scale),
          normalised(motion.direction),
          {rough.clearance},
          distance,
          {rough.tolerance}};
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
  constexpr Real kMargin{16 * Of<Real>::unit};
  const Real clearance = pair.clearance;
  pair.clearance = (std::min(start.least, clearance) - Real{slack}) * (Real{1} - kMargin) - start.error;
  pair.tolerance = Real{0x1p-6} * pair.clearance;
  if (pair.clearance > Real{}) {
    const auto found = search(pair);
    if (found) return found->hi < Real{Of<Real>::never} ? Nearing::yes : Nearing::open;
  }
  pair.clearance = (std::min(start.most, clearance) - Real{slack}) * (Real{1} + kMargin) + start.error;
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

bool certainlyWithin(const exact::Triangle& a, const exact::Triangle& b, const Vector& displacement, double clearance) {
  const int exponent = exponentOf(a, b, std::max(clearance, radar::norm1(displacement)));
  const double scale = std::ldexp(1.0, -exponent);
  Pair<DoubleDouble> pair{
      relative<DoubleDouble>(a, a[0], scale), relative<DoubleDouble>(b, a[0], scale), {}, {}, {}, {}};
  for (Point<DoubleDouble>& corner : pair.gaps) corner = corner - exactly<DoubleDouble>(scaled(scale, displacement));
  return momentAt(pair, DoubleDouble{}).most <= DoubleDouble{scale * clearance};
}

}  // namespace radar::cpu
