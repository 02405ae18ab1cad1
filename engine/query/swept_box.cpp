#include "query/swept_box.h"

#include <algorithm>
#include <cmath>

namespace radar {

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
    rate_[k] = detail::both(usable ? rate : 0);
    rateSize_[k] = detail::both(usable ? std::abs(rate) : 0);
    offset_[k] = detail::both(usable ? middle[k] * rate : 0);
    half_[k] = detail::both(usable ? wide * std::abs(rate) : INFINITY);
  }
}

}  // namespace radar
