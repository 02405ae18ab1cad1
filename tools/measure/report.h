// What a command measured: a JSON document of parts, each a table, that is complete whenever it is written.
//
//   {"title", "verdict", "findings": [line], ..., "parts": [{"name", "title", "state", "note", "seconds", "rows":
//   table, "charts": [name]}]}
//
// A table is an array of objects that all have the same keys: the names of its columns.
#pragma once

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

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

/// Columns that line up, under their names. Fractions have four digits. Where lines would be longer than 120
/// characters, the last columns follow in lines below their row. Empty for a table without rows.
std::string textOf(const Json& table, const std::string& indent = "");

/// A line for the names of the columns, then one for each row. Numbers read back as the same; "yes" or "no" for a
/// boolean, nothing for null and NaN. Empty for a table without rows.
std::string csvOf(const Json& table);

/// With the command, the commit, the day, the processor and what else a reader needs to know; no parts.
Json newReport(const std::string& title, const Json& head = Json::object());
/// The part of that name; if there is none, one that is not begun is added, and references to others become invalid.
Json& partOf(Json& report, const std::string& name, const std::string& title = "");
/// Replaces the part's rows, and says that it is done.
void setRows(Json& report, const std::string& name, const std::string& title, const Json& rows);

/// The verdict, the findings if there are any, and what became of each part; and all of it, which begins so.
std::string summaryOf(const Json& report);
std::string reportText(const Json& report);

/// Writes index.html, a page that loads nothing but the charts; report.json; and each table, as NAME.csv. Throws
/// InputError that names the file.
void writeReport(const std::filesystem::path& folder, const Json& report);

/// Makes the folder that an option names. Throws InputError that names the option if there can be none.
void makeFolder(const char* option, const std::string& folder);

}  // namespace radar::tools
