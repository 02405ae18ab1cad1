// Takes the bytes of an input for choices: of a call, a number, a size. An input that has ended chooses 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace radar::fuzz {

class Choices {
 public:
  explicit Choices(std::string_view bytes) : rest_(bytes) {}

  bool areOver() const { return rest_.empty(); }
  template <class Value>
  Value raw() {
    Value value{};
    const size_t size = std::min(sizeof value, rest_.size());
    if (size > 0) std::memcpy(&value, rest_.data(), size);
    rest_.remove_prefix(size);
    return value;
  }
  uint32_t below(uint32_t limit) { return (limit <= 256 ? raw<uint8_t>() : raw<uint32_t>()) % limit; }
  bool oneIn(uint32_t count) { return below(count) == count - 1; }
  template <class List>
  const auto& of(const List& list) {
    return list[below(static_cast<uint32_t>(std::size(list)))];
  }

  /// Mostly small whole numbers, so that shapes touch; if `wild`, also any bits, and the limits of the type.
  template <class Real>
  Real number(bool wild) {
    using Limits = std::numeric_limits<Real>;
    const std::array limits{Limits::quiet_NaN(), Limits::infinity(),      -Limits::infinity(), Limits::max(),
                            Limits::lowest(),    Limits::denorm_min(),    Limits::min(),       -Limits::denorm_min(),
                            Real(-0.0),          Limits::max() / Real(8), Real(1e-30),         Real(1e30)};
    switch (below(wild ? 16 : 12)) {
      case 15:
        return of(limits);
      case 14:
        return raw<Real>();
      case 13:
      case 12:
        return std::ldexp(Real(raw<int16_t>()), raw<int8_t>() * (Limits::max_exponent / 128));
      case 11:
      case 10:
        return Real(raw<int16_t>()) / Real(4096);
      default:
        return Real(raw<int8_t>() % 5);
    }
  }

 private:
  std::string_view rest_;
};

}  // namespace radar::fuzz
