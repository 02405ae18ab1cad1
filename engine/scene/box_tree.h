// A binary tree over boxes, built top down by the binned surface area heuristic, on all cores.
// I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "math/rounding.h"
#include "scene/large_vector.h"

namespace radar {

struct FloatBox {
  std::array<float, 3> lo, hi;
};

inline FloatBox around(const FloatBox& p, const FloatBox& q) {
  FloatBox box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::min(p.lo[k], q.lo[k]);
    box.hi[k] = std::max(p.hi[k], q.hi[k]);
  }
  return box;
}

/// Centre and half extents of a box that contains another despite rounding.
inline void fitBox(const FloatBox& box, float (&centre)[3], float (&half)[3]) {
  for (int k = 0; k < 3; ++k) {
    centre[k] = 0.5f * box.lo[k] + 0.5f * box.hi[k];
    const float reach = std::max(box.hi[k] - centre[k], centre[k] - box.lo[k]);
    // Flat boxes stay flat, and other extents are normal numbers: subnormal numbers are slow, and devices flush them.
    constexpr float kLeast = std::numeric_limits<float>::min();
    half[k] = reach == 0 ? 0 : std::max(nextAbove(reach), kLeast);
  }
}

/// A box, and the number of what it holds. The fourth numbers hold that, plus kIndex: bits of a float that is neither
/// subnormal nor NaN.
struct alignas(32) BoxedItem {
  static constexpr uint32_t kIndex = 1u << 30;

  BoxedItem() {}
  BoxedItem(const FloatBox& box, uint32_t index)
      : lo{box.lo[0], box.lo[1], box.lo[2], std::bit_cast<float>(kIndex + index)},
        hi{box.hi[0], box.hi[1], box.hi[2], lo[3]} {}
  uint32_t index() const { return std::bit_cast<uint32_t>(lo[3]) - kIndex; }
  FloatBox box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }

  float lo[4], hi[4];
};

struct BoxTree {
  /// A leaf holds `count` items from `first` on; for an inner node, the leaves below hold them.
  struct Node {
    uint32_t first, count;
    uint32_t child;  ///< left child; the right one follows it; 0: a leaf
  };
  /// The root first, children after their parents; empty without items. The nodes below one are consecutive, its
  /// children first.
  UnwrittenVector<Node> nodes;
  uint32_t depth = 0;  ///< nodes on the longest path from the root to a leaf
};

/// Sorts the items leaf by leaf. Leaves hold at most `leafSize` of at most 2^29, whose boxes are finite. `alone`: on
/// the caller's thread, where the tree is the same.
BoxTree buildBoxTree(std::span<BoxedItem> items, uint32_t leafSize, bool alone = false);

}  // namespace radar
