// What tells one query file from another.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace radar::tools {

/// A hash (XXH3, 128 bits) of all that is added, in order: equal bytes give equal hashes on every machine.
class Fingerprint {
 public:
  /// The numbers or characters of a list.
  template <class List>
  void add(const List& list) {
    addBytes(std::as_bytes(std::span(list)));
  }
  /// 32 hexadecimal digits.
  std::string text() const;

 private:
  void addBytes(std::span<const std::byte> bytes);

  std::array<uint64_t, 2> hash_{};
};

}  // namespace radar::tools
