#include "exact/determinant.h"

#include <cmath>

#include "exact/scaled_int.h"

namespace radar::exact {

namespace {

// Two DoubleDouble products of 7 u^2 and three sums of 3 u^2 add up to 23 u^2; differences are exact.
constexpr double kFineRelative = 0x1p-99;

}  // namespace

Estimate estimate(const Determinant& d) {
  const Vector w = rounded(d.w);
  return estimate(w, rounded(d.x), rounded(d.y), underflowOf(w));
}

FineCross::FineCross(const Difference& x, const Difference& y) {
  DoubleDouble a[3], b[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = difference(x.to[k], x.from[k]);
    b[k] = difference(y.to[k], y.from[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    const DoubleDouble p = a[i] * b[j], q = a[j] * b[i];
    minors_[k] = p - q;
    sizes_[k] = std::abs(p.high) + std::abs(q.high);
  }
}

FineEstimate FineCross::along(const Difference& w) const {
  DoubleDouble value;
  double magnitude = 0, size = 1;
  for (int k = 0; k < 3; ++k) {
    const DoubleDouble c = difference(w.to[k], w.from[k]);
    value = value + c * minors_[k];
    magnitude += std::abs(c.high) * sizes_[k];
    size += std::abs(c.high);
  }
  return {value, kFineRelative * magnitude + kUnderflow * size};
}

namespace {

Dyadic component(const Difference& v, int k) {
  return Dyadic(v.to[k]) - Dyadic(v.from[k]);
}

Dyadic dyadicDeterminant(const Determinant& d) {
  Dyadic value;
  for (int k = 0; k < 3; ++k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    const Dyadic w = component(d.w, k);
    if (w.sign() == 0) continue;
    const Dyadic minor = component(d.x, i) * component(d.y, j) - component(d.x, j) * component(d.y, i);
    value = value + w * minor;
  }
  return value;
}

}  // namespace

Dyadic exactly(const Determinant& d) {
  const auto w = scaledVector(d.w), x = scaledVector(d.x), y = scaledVector(d.y);
  if (!w || !x || !y) return dyadicDeterminant(d);
  return determinant(w->c, x->c, y->c).value(w->exponent + x->exponent + y->exponent);
}

int exactSign(const Determinant& d) {
  const auto w = scaledVector(d.w), x = scaledVector(d.x), y = scaledVector(d.y);
  return w && x && y ? determinant(w->c, x->c, y->c).sign() : dyadicDeterminant(d).sign();
}

int sign(const Determinant& d) {
  const Estimate rough = estimate(d);
  return std::abs(rough.value) > rough.error ? signOf(rough.value) : exactSign(d);
}

int crossSign(const Difference& v, const Difference& w, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double p = (v.to[i] - v.from[i]) * (w.to[j] - w.from[j]), q = (v.to[j] - v.from[j]) * (w.to[i] - w.from[i]);
  if (std::abs(p - q) > kRelative * (std::abs(p) + std::abs(q)) + kUnderflow) return signOf(p - q);
  const auto a = scaledVector(v), b = scaledVector(w);
  if (a && b) return determinant({axis == 0, axis == 1, axis == 2}, a->c, b->c).sign();
  return (component(v, i) * component(w, j) - component(v, j) * component(w, i)).sign();
}

}  // namespace radar::exact
