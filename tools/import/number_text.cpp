#include "import/number_text.h"

#include <algorithm>
#include <charconv>

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

std::optional<uint64_t> wholeNumber(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace radar::tools
