// Orders the pairs of nodes in the lanes of a test by when they may meet.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "cpu/node_test.h"

namespace radar::cpu {

inline namespace RADAR_WIDTH {

using Keys = int32_t __attribute__((vector_size(4 * kLanes)));
inline constexpr int32_t kNever = 0x7f800000;  // the bits of infinity
// The low bits of a key have the lane's number: as many with any number of lanes, since brackets of turns depend on
// what they round off.
inline constexpr int32_t kLaneOfKey = 7;
static_assert(kLanes <= kLaneOfKey + 1);

inline float nearOf(int32_t key) {
  return std::bit_cast<float>(std::max(key, 0) & ~kLaneOfKey);
}

/// Compares each lane's key with that of the lane whose number differs by `bits`; the lower lane takes the larger key.
template <int bits>
Keys exchanged(const Keys& keys) {
  const Keys others = picked(keys, keys, [](int lane) { return lane ^ bits; });
  const Keys small = keys < others ? keys : others, large = keys < others ? others : keys;
  return picked(large, small, [](int lane) { return lane < (lane ^ bits) ? lane : lane + kLanes; });
}

/// The largest first: a bitonic network, without a branch, which nothing could foresee.
inline Keys sorted(Keys keys) {
  keys = exchanged<1>(keys);
  keys = exchanged<3>(keys);
  keys = exchanged<1>(keys);
  if constexpr (kLanes > 4) {
    keys = exchanged<7>(keys);
    keys = exchanged<2>(keys);
    keys = exchanged<1>(keys);
  }
  return keys;
}

/// The pairs that may meet by a time.
struct Ordered {
  int32_t keys[kLanes];  ///< the last `count`, nearest last; they order like the times from which they may meet
  int count;
};

/// Orders the lanes. Of the pairs that may meet at the start, the one whose interval begins earliest is nearest: it
/// usually is the deepest. In shapes that interlock, most pairs may meet at the start.
template <class Real>
Ordered inOrder(const Times<Real>& times, unsigned valid, float latest) {
  using L = Lanes<Real>;
  L from = times.from;
  if constexpr (sizeof(Real) > sizeof(float)) {
    // Moved down by more than the conversion can round up, and clamped to the range of floats.
    from = from - abs(from) * L(0x1p-23);
    from = max(L(-0x1p100), min(from, L(0x1p100)));
  }
  from = select(max(times.from, L(0)), times.to, L(Real(INFINITY)), from);
  const Floats floats = from.floats();
  Keys numbers, bit;
  for (int i = 0; i < kLanes; ++i) {
    numbers[i] = i;
    bit[i] = 1 << i;
  }
  const Keys isWanted = Keys((bit & static_cast<int32_t>(valid)) != 0) & Keys(floats <= latest);
  const auto bits = Keys(floats);
  const Keys keys = ((bits ^ (bits >> 31 & 0x7fffffff)) & ~kLaneOfKey) | numbers;
  const Keys ordered = sorted(isWanted ? keys : Keys{} + kNever);
  Ordered out;
  std::memcpy(out.keys, &ordered, sizeof(out.keys));
  out.count = std::popcount(signsOf(isWanted));
  return out;
}

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
