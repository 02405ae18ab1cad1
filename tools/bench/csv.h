// Tables of comma-separated values.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace radar::bench {

/// A line of these cells, which are quoted where they have to be.
std::string csvLine(const std::vector<std::string>& cells);

/// The cells of each line. Lines that begin with # are left out. Throws InputError that names the line where a quote is
/// not closed.
std::vector<std::vector<std::string>> readCsv(const std::string& file, std::string_view text);

/// The shortest number that reads back as the same; nothing for NaN.
std::string csvNumber(double value);

template <class Value>
std::string csvCell(const Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    return value ? "yes" : "no";
  } else if constexpr (std::is_floating_point_v<Value>) {
    return csvNumber(value);
  } else if constexpr (std::is_integral_v<Value>) {
    return std::to_string(value);
  } else {
    return std::string(value);
  }
}

/// A line of texts, numbers, and "yes" or "no".
template <class... Values>
std::string csvLineOf(const Values&... values) {
  return csvLine({csvCell(values)...});
}

}  // namespace radar::bench
