#include "import/number_text.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace radar::tools {

namespace {

/// Whether a decimal number is 1 or more, to about a factor of 10.
bool isLarge(std::string_view text) {
  const size_t mantissa = std::min(text.find_first_of("eE"), text.size());
  const size_t point = std::min(text.find('.'), mantissa), first = text.find_first_of("123456789");
  int64_t exponent = 0;
  if (mantissa < text.size()) {
    text.remove_prefix(mantissa + 1);
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
    if (error != std::errc()) return !text.starts_with('-');
  }
  return static_cast<int64_t>(point) - static_cast<int64_t>(first) + exponent > 0;
}

}  // namespace

template <class Real>
std::optional<Real> nearest(std::string_view text) {
  // from_chars takes no plus.
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Real value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc::invalid_argument || end != last) return {};
  if (error != std::errc::result_out_of_range) return value;
  if (isLarge(text)) return {};
  return text.starts_with('-') ? -Real(0) : Real(0);
}
template std::optional<float> nearest<float>(std::string_view);
template std::optional<double> nearest<double>(std::string_view);

std::optional<double> inFloatRange(double value) {
  if (std::isfinite(value) && std::isinf(static_cast<float>(value))) return {};
  return value;
}

std::optional<double> coordinate(std::string_view text) {
  const std::optional<double> value = nearest<double>(text);
  if (!value || *value == 0 || !std::isfinite(*value)) return value;
  // Halfway between two floats, as far as the double tells, the text decides, which has more digits.
  constexpr uint64_t kBelowFloat = (uint64_t(1) << 29) - 1;
  const bool isHalfway = (std::bit_cast<uint64_t>(*value) & kBelowFloat) == (kBelowFloat + 1) / 2;
  if (!isHalfway && std::abs(*value) >= double(std::numeric_limits<float>::min())) return inFloatRange(*value);
  const std::optional<float> rounded = nearest<float>(text);
  if (!rounded || static_cast<float>(*value) == *rounded) return rounded ? value : std::nullopt;
  return std::nextafter(*value, double(*rounded));
}

std::optional<uint64_t> wholeNumber(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace radar::tools
