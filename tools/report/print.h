// Text of numbers.
#pragma once

#include <cstdio>
#include <string>

namespace radar::tools {

/// printf into a string.
template <class... Values>
std::string print(const char* format, Values... values) {
  const int size = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<size_t>(size) + 1, '\0');
  std::snprintf(text.data(), text.size(), format, values...);
  text.pop_back();
  return text;
}

/// A whole number with commas: "10,000".
inline std::string grouped(double value) {
  std::string text = print("%.0f", value);
  for (size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

}  // namespace radar::tools
