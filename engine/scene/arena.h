// Places for ranges of elements in an array of fixed size.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace radar {

class Arena {
 public:
  /// Frees everything.
  void reset(uint64_t capacity);
  /// The first element of the first free range of `count`; none if there is none.
  std::optional<uint64_t> allocate(uint64_t count);
  /// Frees a range that was allocated.
  void free(uint64_t first, uint64_t count);

 private:
  std::map<uint64_t, uint64_t> free_;  // first element and count, apart
};

}  // namespace radar
