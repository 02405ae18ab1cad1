// Tables of results, as text for a terminal and as comma-separated values. A table is a JSON array of objects that all
// have the same keys: the names of its columns.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace radar::tools {

using Json = nlohmann::ordered_json;

/// printf into a string.
template <class... Values>
std::string print(const char* format, Values... values) {
  std::string text(static_cast<size_t>(std::snprintf(nullptr, 0, format, values...)) + 1, '\0');
  std::snprintf(text.data(), text.size(), format, values...);
  text.pop_back();
  return text;
}

/// A value as a cell of textOf() has it.
std::string cellText(const Json& value);

/// Columns that line up, under their names. Fractions have four digits. Where lines would be longer than 120
/// characters, the last columns of text follow in lines below their row. Empty for a table without rows.
std::string textOf(const Json& table, const std::string& indent = "");

/// A line for the names of the columns, then one for each row, as csvLine(). Fractions have six digits. Empty for a
/// table without rows.
std::string csvOf(const Json& table);

/// A line with the values of an array or an object. Numbers read back as the same; "yes" or "no" for a boolean,
/// nothing for null and NaN.
std::string csvLine(const Json& values);

/// The cells of each line. Lines that begin with # are left out. Throws InputError that names the line where a quote is
/// not closed.
std::vector<std::vector<std::string>> readCsv(const std::string& file, std::string_view text);

/// Makes the folder that an option names. Throws InputError that names the option if there can be none.
void makeFolder(const char* option, const std::string& folder);

}  // namespace radar::tools
