#include "query/swept_box.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace radar {

namespace {

using FourFloats = float __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));

TwoDoubles both(double x) {
  return TwoDoubles{x, x};
}

/// Of two nodes, side by side for each axis.
struct Points {
  TwoDoubles axes[3];

  /// From the first three of four floats each.
  Points(const void* first, const void* second) {
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

}  // namespace

SweptBox::SweptBox(const Box& box, const Piece& piece, const ObjectTree& tree) {
  const Box& world = tree.worldBox();
  Vector middle, half, magnitude;
  double latest = piece.wayUntil(piece.end);
  for (int k = 0; k < 3; ++k) {
    const double anchor = tree.anchor()[k], speed = std::abs(piece.unit[k]);
    const double reach = 2 * std::max(std::abs(world.lo[k] - anchor), std::abs(world.hi[k] - anchor));
    middle[k] = box.middle(k) - anchor;
    half[k] = 0.5 * box.hi[k] - 0.5 * box.lo[k] + piece.deviation;
    magnitude[k] = std::abs(box.middle(k)) + half[k] + std::abs(anchor) + reach;
    // Once the box has passed all objects along an axis, it meets none of them any more.
    if (const double passed = 1.01 * (std::abs(middle[k]) + half[k] + reach) / speed; speed > 0.5 && passed < latest) {
      latest = passed;
    }
  }
  latest = std::max(latest, 0x1p-1000);
  for (int k = 0; k < 3; ++k) {
    const double speed = piece.unit[k], rounding = 32 * kUnit * (magnitude[k] + latest * std::abs(speed)) + 0x1p-1000;
    // A speed near 0 is raised; `wide` covers the difference.
    const double used = std::copysign(std::max(std::abs(speed), rounding / latest), speed), rate = 1 / used;
    const double wide = half[k] + rounding + latest * std::abs(used - speed);
    const bool usable = (magnitude[k] + wide) * std::abs(rate) < 0x1p900;
    rate_[k] = both(usable ? rate : 0);
    rateSize_[k] = both(usable ? std::abs(rate) : 0);
    offset_[k] = both(usable ? middle[k] * rate : 0);
    half_[k] = both(usable ? wide * std::abs(rate) : INFINITY);
  }
}

TwoDoubles SweptBox::operator()(const gpu::ObjectNode& first, const gpu::ObjectNode& second) const {
  static_assert(offsetof(gpu::ObjectNode, link) == 12 && offsetof(gpu::ObjectNode, pad) == 28);
  const Points centre(&first, &second), halfExtent(&first.halfExtent, &second.halfExtent);
  TwoDoubles from = both(0), to = both(INFINITY);
  for (int k = 0; k < 3; ++k) {
    const TwoDoubles middle = rate_[k] * centre.axes[k] - offset_[k];
    const TwoDoubles half = rateSize_[k] * halfExtent.axes[k] + half_[k];
    const TwoDoubles begin = middle - half, end = middle + half;
    from = begin > from ? begin : from;
    to = end < to ? end : to;
  }
  return from <= to ? from : both(INFINITY);
}

}  // namespace radar
