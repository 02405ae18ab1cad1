#include "exact/event.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "exact/determinant.h"
#include "exact/scaled_int.h"
#include "math/rounding.h"

namespace radar::exact {

namespace {

// Covers underflow, with a margin; subnormal numbers would be slow.
constexpr double kLeast = 0x1p-1000;
// Products that cancel by more than this cost a normal in double-doubles too many bits (describe.comp).
constexpr double kMostCancelled = 0x1p40;

Determinant numerator(const Event& e) {
  return {{e.from, e.to}, {e.x0, e.x1}, {e.y0, e.y1}};
}

Determinant denominator(const Event& e) {
  return {{kOrigin, e.direction}, {e.x0, e.x1}, {e.y0, e.y1}};
}

/// Creates an event and computes its parameter. With num = n + dn, den = d + dd: n/d - num/den = (dn - (n/d) dd) /
/// -den.
Event evaluated(Kind kind, const Vector& direction, const Vector& from, const Vector& to, const Vector& x0,
                const Vector& x1, const Vector& y0, const Vector& y1) {
  Event e{kind, direction, from, to, x0, x1, y0, y1, 0, 0};
  // Inlined, both share the products of x and y.
  const Vector gap = rounded({from, to}), x = rounded({x0, x1}), y = rounded({y0, y1});
  const Estimate num = estimate(gap, x, y, underflowOf(gap)), den = estimate(direction, x, y, underflowOf(direction));
  e.s = num.value / den.value;
  const double sure = std::abs(den.value) - den.error;
  e.error = sure > 0 ? (1 + 8 * kUnit) * ((num.error + std::abs(e.s) * den.error) / sure + 2 * kUnit * std::abs(e.s)) +
                           4 * kLeast
                     : std::numeric_limits<double>::infinity();
  return e;
}

Vector unit(int axis) {
  Vector v{};
  v[axis % 3] = 1;
  return v;
}

struct FineParameter {
  DoubleDouble s;
  double error;
};

/// The parameter as a double-double, by one step of long division, whose own error is below 2^-102 |s|.
FineParameter fineParameter(const Event& e) {
  const FineCross cross({e.x0, e.x1}, {e.y0, e.y1});
  const FineEstimate num = cross.along({e.from, e.to}), den = cross.along({kOrigin, e.direction});
  const double first = num.value.high / den.value.high;
  const DoubleDouble rest = num.value - DoubleDouble{first, 0} * den.value;
  const DoubleDouble s = quickSum(first, rest.high / den.value.high);
  const double sure = std::abs(den.value.high) * (1 - 2 * kUnit) - den.error, size = std::abs(s.high);
  const double error =
      sure > 0 ? (1 + 8 * kUnit) * ((num.error + size * den.error) / sure) + 0x1p-100 * size + 0x1p-1000 : INFINITY;
  return {s, error};
}

}  // namespace

Triangle sorted(Triangle t) {
  if (t[1] < t[0]) std::swap(t[0], t[1]);
  if (t[2] < t[1]) std::swap(t[1], t[2]);
  if (t[1] < t[0]) std::swap(t[0], t[1]);
  return t;
}

Event vertexFace(const Vector& direction, const Vector& a, const Triangle& b) {
  const Triangle f = sorted(b);
  return evaluated(Kind::vertexFace, direction, a, f[0], f[0], f[1], f[0], f[2]);
}

Event faceVertex(const Vector& direction, const Triangle& a, const Vector& b) {
  const Triangle f = sorted(a);
  return evaluated(Kind::faceVertex, direction, f[0], b, f[0], f[1], f[0], f[2]);
}

Event edgeEdge(const Vector& direction, const Vector& a0, const Vector& a1, const Vector& b0, const Vector& b1) {
  const auto [p0, p1] = std::minmax(a0, a1);
  const auto [q0, q1] = std::minmax(b0, b1);
  return evaluated(Kind::edgeEdge, direction, p0, q0, p0, p1, q0, q1);
}

Event vertexEdge(const Vector& direction, const Vector& a, const Vector& b0, const Vector& b1, int axis) {
  const auto [q0, q1] = std::minmax(b0, b1);
  return evaluated(Kind::vertexEdge, direction, a, q0, q0, q1, kOrigin, unit(axis));
}

Event edgeVertex(const Vector& direction, const Vector& a0, const Vector& a1, const Vector& b, int axis) {
  const auto [p0, p1] = std::minmax(a0, a1);
  return evaluated(Kind::edgeVertex, direction, p0, b, p0, p1, kOrigin, unit(axis));
}

Event vertexVertex(const Vector& direction, const Vector& a, const Vector& b) {
  int axis = 0;
  while (direction[axis] == 0) ++axis;
  return evaluated(Kind::vertexVertex, direction, a, b, kOrigin, unit(axis + 1), kOrigin, unit(axis + 2));
}

bool precedes(const Event& p, const Event& q) {
  return std::tie(p.kind, p.from, p.to, p.x0, p.x1, p.y0, p.y1, p.direction) <
         std::tie(q.kind, q.from, q.to, q.x0, q.x1, q.y0, q.y1, q.direction);
}

namespace {

bool isSame(const Event& p, const Event& q) {
  return p.kind == q.kind && p.from == q.from && p.to == q.to && p.x0 == q.x0 && p.x1 == q.x1 && p.y0 == q.y0 &&
         p.y1 == q.y1 && p.direction == q.direction;
}

bool isAcross(const Event& e, int axis) {
  return e.x0[axis] == e.x1[axis] && e.y0[axis] == e.y1[axis];
}

/// Compares parameters of features that lie across one axis: there, the determinants' quotient is that of the gap's and
/// the direction's components. Shapes of boxes touch in very many such events at once.
std::optional<int> compareAcross(const Event& p, const Event& q) {
  if (p.direction != q.direction) return std::nullopt;
  int axis = 0;
  while (axis < 3 && !(isAcross(p, axis) && isAcross(q, axis))) ++axis;
  if (axis == 3) return std::nullopt;
  const DoubleDouble u = difference(p.to[axis], p.from[axis]), v = difference(q.to[axis], q.from[axis]);
  if (!std::isfinite(u.low) || !std::isfinite(v.low)) return std::nullopt;
  const int order = u.high != v.high ? signOf(u.high - v.high) : signOf(u.low - v.low);
  return p.direction[axis] > 0 ? order : -order;
}

}  // namespace

int sign(const Event& e) {
  if (std::abs(e.s) > e.error) return signOf(e.s);
  return sign(numerator(e)) * sign(denominator(e));
}

Ratio ratio(const Event& e) {
  const Difference gap{e.from, e.to}, way{kOrigin, e.direction};
  const auto x = scaledVector({e.x0, e.x1}), y = scaledVector({e.y0, e.y1}), g = scaledVector(gap),
             w = scaledVector(way);
  if (!x || !y || !g || !w) return {exactly(numerator(e)), exactly(denominator(e))};
  const IntNormal normal = cross(x->c, y->c);
  const int exponent = x->exponent + y->exponent;
  return {dot(g->c, normal).value(g->exponent + exponent), dot(w->c, normal).value(w->exponent + exponent)};
}

int compare(const Ratio& p, const Ratio& q) {
  return (p.num * q.den - q.num * p.den).sign() * p.den.sign() * q.den.sign();
}

std::optional<int> compareRoughly(const Event& p, const Event& q) {
  const double apart = p.s - q.s, margin = (1 + 8 * kUnit) * (p.error + q.error);
  if (std::abs(apart) > margin) return signOf(apart);
  if (isSame(p, q)) return 0;
  if (const auto order = compareAcross(p, q)) return order;
  // Equal estimates are most likely a tie, which only exact arithmetic can decide.
  if (apart == 0) return std::nullopt;
  const FineParameter fp = fineParameter(p), fq = fineParameter(q);
  const DoubleDouble fine = fp.s - fq.s;
  if (std::abs(fine.high) > (1 + 8 * kUnit) * (fp.error + fq.error)) return signOf(fine.high);
  return std::nullopt;
}

int compare(const Event& p, const Event& q) {
  if (const auto order = compareRoughly(p, q)) return *order;
  return compare(ratio(p), ratio(q));
}

int compareToDistance(const Event& e, double distance) {
  const double size = std::hypot(e.direction[0], e.direction[1], e.direction[2]);
  const double t = e.s * size, margin = (1 + 32 * kUnit) * e.error * size + 32 * kUnit * std::abs(t) + kLeast;
  if (std::abs(t - distance) > margin) return signOf(t - distance);
  const int side = sign(e);
  if (side < 0) return -1;
  if (side == 0) return distance == 0 ? 0 : -1;
  const Dyadic num = exactly(numerator(e)), den = exactly(denominator(e)), end = Dyadic(distance) * den;
  Dyadic square;
  for (double c : e.direction) square = square + Dyadic(c) * Dyadic(c);
  return (num * num * square - end * end).sign();
}

int compareToParameter(const Event& e, double parameter) {
  const double apart = e.s - parameter;
  if (std::abs(apart) > (1 + 8 * kUnit) * (e.error + 2 * kUnit * std::abs(apart))) return signOf(apart);
  const Dyadic den = exactly(denominator(e));
  return (exactly(numerator(e)) - Dyadic(parameter) * den).sign() * den.sign();
}

double parameter(const Event& e) {
  const FineParameter fine = fineParameter(e);
  if (fine.error <= 0x1p-60 * std::abs(fine.s.high)) return fine.s.high;
  return quotient(exactly(numerator(e)), exactly(denominator(e)));
}

namespace {

/// Corrects an estimate: the length is between the midpoints from its nearest double to that double's neighbours.
double exactLength(const Vector& d, double root) {
  Dyadic square;
  for (double c : d) square = square + Dyadic(c) * Dyadic(c);
  const Dyadic fourfold = square * Dyadic(4);
  // Infinity stands for 2^1024, the neighbour of the greatest double.
  const auto exactly = [](double x) { return std::isinf(x) ? Dyadic(0x1p1023) * Dyadic(2) : Dyadic(x); };
  const auto isBeyond = [&](double p, double q) {  // compares twice the length with p + q
    const Dyadic sum = exactly(p) + exactly(q);
    return (fourfold - sum * sum).sign();
  };
  while (!std::isinf(root)) {
    const double up = std::nextafter(root, INFINITY), down = std::nextafter(root, 0);
    if (isBeyond(root, up) > 0) {
      root = up;
    } else if (isBeyond(down, root) < 0) {
      root = down;
    } else {
      return root;
    }
  }
  return root;
}

}  // namespace

double length(const Vector& d) {
  // Where no square that counts overflows or is subnormal, the plain root is near enough.
  const double plain = radar::dot(d, d);
  const double root = plain >= 0x1p-800 && plain <= 0x1p800 ? std::sqrt(plain) : std::hypot(d[0], d[1], d[2]);
  if (!std::isfinite(root)) return root;
  if (root < 0x1p-400 || root > 0x1p400) return exactLength(d, root);
  DoubleDouble square;
  for (double c : d) square = square + product(c, c);
  // |d| - root = (|d|^2 - root^2) / (|d| + root), correct to 40 bits.
  const double rest = (square - product(root, root)).high / (2 * root),
               error = 0x1p-40 * std::abs(rest) + 0x1p-90 * root;
  const double below = root + (rest - error), above = root + (rest + error);
  return below == above ? below : exactLength(d, root);
}

Vector point(const Event& e, double s) {
  switch (e.kind) {
    case Kind::vertexFace:
    case Kind::vertexEdge:
      return withoutZeroSigns(along(e.from, s, e.direction));
    case Kind::faceVertex:
    case Kind::edgeVertex:
    case Kind::vertexVertex:
      return withoutZeroSigns(e.to);
    case Kind::edgeEdge:
      break;
  }
  // The orientations of the resting edge's ends, y0 and y1, give the share of the edge at which the moving edge
  // crosses.
  const Difference d{kOrigin, e.direction};
  const Determinant at0{d, {e.y0, e.x0}, {e.y0, e.x1}}, at1{d, {e.y1, e.x0}, {e.y1, e.x1}};
  const FineEstimate p = fineEstimate(at0), q = fineEstimate(at1);
  const double both = (p.value - q.value).high;
  double share = p.value.high / both;
  // Not where a device is certain of the signs of both (describe.comp).
  if (!(p.error + q.error <= 0x1p-45 * std::abs(both))) {
    const Dyadic above = exactly(at0);
    share = quotient(above, above - exactly(at1));
  }
  return withoutZeroSigns(along(e.y0, std::clamp(share, 0.0, 1.0), rounded({e.y0, e.y1})));
}

namespace {

/// Scales numbers by powers of two so that the largest is from 1 to 2.
class Scale {
 public:
  explicit Scale(const Vector& v)
      : size_(std::ilogb(largest(v))), factor_(std::abs(size_) < 1000 ? std::ldexp(1.0, -size_) : 0) {}
  double operator()(double x) const { return factor_ != 0 ? factor_ * x : std::ldexp(x, -size_); }

 private:
  int size_;
  double factor_;  // 0: the power may not be a number
};

/// The square root of 1 <= x < 16, by operations with the same bits on every device (root.glsl).
double rootOf(double x) {
  double root = 0.5 * (1 + x);
  for (int i = 0; i < 7; ++i) root = 0.5 * (root + x / root);
  return root;
}

Vector unitOf(Vector n, double turn) {
  const Scale scale(n);
  for (double& c : n) c = scale(c);
  const double root = rootOf(radar::dot(n, n));
  for (double& c : n) c = turn * c / root;
  return withoutZeroSigns(n);
}

}  // namespace

Vector unitOf(const Three<Dyadic>& v) {
  size_t most = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (v[k].sign() != 0 && (v[most].sign() == 0 || std::abs(quotient(v[k], v[most])) > 1)) most = k;
  }
  Vector n;
  for (size_t k = 0; k < 3; ++k) n[k] = v[most].sign() * quotient(v[k], v[most]);
  return unitOf(n, 1);
}

Vector normal(const Event& e) {
  if (e.kind > Kind::edgeEdge) return {NAN, NAN, NAN};
  DoubleDouble x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = difference(e.x1[k], e.x0[k]);
    y[k] = difference(e.y1[k], e.y0[k]);
  }
  // Scaled by powers of two, so that products of tiny and huge edges neither underflow nor overflow.
  for (DoubleDouble* v : {x, y}) {
    const Scale scale({v[0].high, v[1].high, v[2].high});
    for (int k = 0; k < 3; ++k) v[k] = {scale(v[k].high), scale(v[k].low)};
  }
  Vector n;
  double most = 0, products = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    const DoubleDouble p = x[i] * y[j], q = x[j] * y[i];
    n[k] = (p - q).high;
    most = std::max(most, std::abs(n[k]));
    products = std::max(products, std::abs(p.high) + std::abs(q.high));
  }
  const int side = sign(denominator(e));
  // The components are off by 2^-99 of the products. Devices then leave the pair to the CPU.
  if (!(products < kMostCancelled * most)) {
    Three<Dyadic> exact;
    for (int k = 0; k < 3; ++k) exact[k] = Dyadic(-side) * exactly({{kOrigin, unit(k)}, {e.x0, e.x1}, {e.y0, e.y1}});
    return unitOf(exact);
  }
  return unitOf(n, -side);
}

}  // namespace radar::exact
