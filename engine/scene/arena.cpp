#include "scene/arena.h"

#include <iterator>

namespace radar {

void Arena::reset(uint64_t capacity) {
  free_.clear();
  if (capacity > 0) free_[0] = capacity;
}

std::optional<uint64_t> Arena::allocate(uint64_t count) {
  if (count == 0) return 0;
  for (auto range = free_.begin(); range != free_.end(); ++range) {
    if (range->second < count) continue;
    const auto [first, room] = *range;
    free_.erase(range);
    if (room > count) free_[first + count] = room - count;
    return first;
  }
  return std::nullopt;
}

void Arena::free(uint64_t first, uint64_t count) {
  if (count == 0) return;
  auto range = free_.emplace(first, count).first;
  if (const auto next = std::next(range); next != free_.end() && next->first == first + count) {
    range->second += next->second;
    free_.erase(next);
  }
  if (range == free_.begin()) return;
  if (const auto before = std::prev(range); before->first + before->second == first) {
    before->second += range->second;
    free_.erase(range);
  }
}

}  // namespace radar
