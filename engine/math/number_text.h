// Numbers in messages.
#pragma once

#include <charconv>
#include <cmath>
#include <string>

namespace radar {

/// The shortest decimal number that reads back as the same double; "nan", "inf".
inline std::string textOf(double value) {
  if (std::isnan(value)) return "nan";  // of either sign
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace radar
