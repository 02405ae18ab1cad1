// Bounds the distances at which a moving world box meets boxes of the tree over objects. docs/method.md derives the
// error bounds.
#pragma once

#include <cstddef>
#include <cstring>

#include "exact/translation.h"
#include "scene/object_tree.h"

namespace radar {

using TwoDoubles = double __attribute__((vector_size(16)));

namespace detail {

inline TwoDoubles both(double x) {
  return TwoDoubles{x, x};
}

/// Of two nodes, side by side for each axis.
struct Points {
  TwoDoubles axes[3];

  /// From the first three of four floats each.
  Points(const void* first, const void* second) {
    using FourFloats = float __attribute__((vector_size(16)));
    using FourDoubles = double __attribute__((vector_size(32)));
    FourFloats p, q;
    std::memcpy(&p, first, sizeof p);
    std::memcpy(&q, second, sizeof q);
    // Four at a time: the compiler converts two one by one.
    const auto xy = __builtin_convertvector(__builtin_shufflevector(p, q, 0, 4, 1, 5), FourDoubles);
    const auto z = __builtin_convertvector(__builtin_shufflevector(p, q, 2, 6, 2, 6), FourDoubles);
    axes[0] = __builtin_shufflevector(xy, xy, 0, 1);
    axes[1] = __builtin_shufflevector(xy, xy, 2, 3);
    axes[2] = __builtin_shufflevector(z, z, 0, 1);
  }
};

}  // namespace detail

class SweptBox {
 public:
  /// `tree` must be in range.
  SweptBox(const Box& box, const Piece& piece, const ObjectTree& tree);

  /// Lower bounds on the distances, world units, at which the boxes of two nodes are met; infinite if they are not.
  TwoDoubles operator()(const gpu::ObjectNode& first, const gpu::ObjectNode& second) const;

 private:
  TwoDoubles rate_[3], rateSize_[3], offset_[3], half_[3];
};

inline TwoDoubles SweptBox::operator()(const gpu::ObjectNode& first, const gpu::ObjectNode& second) const {
  static_assert(offsetof(gpu::ObjectNode, link) == 12 && offsetof(gpu::ObjectNode, pad) == 28);
  const detail::Points centre(&first, &second), halfExtent(&first.halfExtent, &second.halfExtent);
  TwoDoubles from = detail::both(0), to = detail::both(INFINITY);
  for (int k = 0; k < 3; ++k) {
    const TwoDoubles middle = rate_[k] * centre.axes[k] - offset_[k];
    const TwoDoubles half = rateSize_[k] * halfExtent.axes[k] + half_[k];
    const TwoDoubles begin = middle - half, end = middle + half;
    from = begin > from ? begin : from;
    to = end < to ? end : to;
  }
  return from <= to ? from : detail::both(INFINITY);
}

}  // namespace radar
