// Numbers in text, whatever the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace radar::tools {

/// The number nearest to the decimal number that `text` is, of two equally near ones the even one. Takes "nan" and
/// "inf", too. Nothing if the number is too large, or if `text` is anything else or only begins with a number.
template <class Real>
std::optional<Real> nearest(std::string_view text);

/// Nothing for a finite number that would be infinite as a float.
std::optional<double> inFloatRange(double value);

/// Of a coordinate: nearest<double>, except that the float nearest to it is nearest<float>, too, which may take an ulp.
/// Nothing also if that is out of range.
std::optional<double> coordinate(std::string_view text);

/// A whole number without a sign.
std::optional<uint64_t> wholeNumber(std::string_view text);

}  // namespace radar::tools
