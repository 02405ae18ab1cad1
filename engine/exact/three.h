// Vectors of numbers that are not rounded: Dyadic, or Bounded (bounded.h), which has operations of its own.
#pragma once

#include <array>

#include "exact/dyadic.h"
#include "math/vector.h"

namespace radar::exact {

template <class Number>
using Three = std::array<Number, 3>;

template <class Number>
Three<Number> numbers(const Vector& v) {
  return {Number(v[0]), Number(v[1]), Number(v[2])};
}

inline Dyadic inner(const Three<Dyadic>& p, const Three<Dyadic>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/// p q - r s.
inline Dyadic minor(const Dyadic& p, const Dyadic& q, const Dyadic& r, const Dyadic& s) {
  return p * q - r * s;
}

template <class Number>
Three<Number> crossProduct(const Three<Number>& p, const Three<Number>& q) {
  return {minor(p[1], q[2], p[2], q[1]), minor(p[2], q[0], p[0], q[2]), minor(p[0], q[1], p[1], q[0])};
}

}  // namespace radar::exact
