#include "report/tables.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "import/input_error.h"

namespace radar::tools {

namespace {

bool isNumber(const Json& value) {
  return value.is_number() || value.is_null();
}

// Digits of fractions; exact: as many as it takes to read them back as the same.
constexpr int kText = 4, kCsv = 6, kExact = 0;
constexpr size_t kWidth = 120;  // of lines of text

std::string cellOf(const Json& value, int digits) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number_float()) return value.dump();
  const auto number = value.get<double>();
  if (std::isnan(number)) return "";
  const bool isLarge = std::abs(number) >= std::pow(10, digits);
  if (digits != kExact) return isLarge ? print("%.0f", number) : print("%.*g", digits, number);
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string lineOf(const Json& values, int digits) {
  std::string line;
  for (const Json& value : values) {
    std::string cell = cellOf(value, digits);
    if (cell.find_first_of(",\"\n#") != std::string::npos) {
      for (size_t at = 0; (at = cell.find('"', at)) != std::string::npos; at += 2) cell.insert(at, 1, '"');
      cell = '"' + cell + '"';
    }
    line += (&value == &*values.begin() ? "" : ",") + cell;
  }
  return line + "\n";
}

// The cells from `first` on, with their names, in lines that are as full as they may be.
std::string linesBelow(const std::vector<std::string>& names, const std::vector<std::string>& cells, size_t first,
                       const std::string& indent) {
  std::string text, line;
  for (size_t k = first; k < cells.size(); ++k) {
    if (cells[k].empty()) continue;
    const std::string item = names[k] + ": " + cells[k];
    if (!line.empty() && indent.size() + line.size() + 2 + item.size() > kWidth) {
      text += indent + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : "; ") + item;
  }
  return line.empty() ? text : text + indent + line + "\n";
}

}  // namespace

std::string cellText(const Json& value) {
  return cellOf(value, kText);
}

std::string textOf(const Json& table, const std::string& indent) {
  if (table.empty()) return "";
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& [name, value] : table.front().items()) lines[0].push_back(name);
  for (const Json& row : table) {
    std::vector<std::string>& cells = lines.emplace_back();
    for (const Json& value : row) cells.push_back(cellText(value));
  }
  std::vector<size_t> widths(lines[0].size());
  for (const std::vector<std::string>& cells : lines) {
    for (size_t k = 0; k < cells.size(); ++k) widths[k] = std::max(widths[k], cells[k].size());
  }
  const auto isRight = [&](size_t k) {
    return isNumber(*std::next(table.front().begin(), static_cast<std::ptrdiff_t>(k)));
  };
  size_t inLine = widths.size();
  size_t width = std::accumulate(widths.begin(), widths.end(), indent.size() + 2 * (inLine - 1));
  for (; width > kWidth && inLine > 1 && !isRight(inLine - 1); --inLine) width -= widths[inLine - 1] + 2;
  std::string text;
  for (const std::vector<std::string>& cells : lines) {
    std::string line = indent;
    for (size_t k = 0; k < inLine; ++k) {
      const std::string padding(widths[k] - cells[k].size(), ' ');
      line += (k == 0 ? "" : "  ") + (isRight(k) ? padding + cells[k] : cells[k] + padding);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    if (&cells != &lines[0]) text += linesBelow(lines[0], cells, inLine, indent + "  ");
  }
  return text;
}

std::string csvOf(const Json& table) {
  if (table.empty()) return "";
  Json names = Json::array();
  for (const auto& [name, value] : table.front().items()) names.push_back(name);
  std::string text = lineOf(names, kCsv);
  for (const Json& row : table) text += lineOf(row, kCsv);
  return text;
}

std::string csvLine(const Json& values) {
  return lineOf(values, kExact);
}

std::vector<std::vector<std::string>> readCsv(const std::string& file, std::string_view text) {
  std::vector<std::vector<std::string>> lines;
  for (size_t at = 0, number = 1; at < text.size(); ++number) {
    if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size() - 1) + 1;
      continue;
    }
    std::vector<std::string>& cells = lines.emplace_back(1);
    bool isQuoted = false;
    for (; at < text.size() && (isQuoted || text[at] != '\n'); ++at) {
      const char c = text[at];
      if (c == '"') {
        // Of two quotes in a row within a quoted cell, one is meant.
        if (!isQuoted && at > 0 && text[at - 1] == '"') cells.back() += c;
        isQuoted = !isQuoted;
      } else if (c == ',' && !isQuoted) {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    if (isQuoted) {
      throw InputError(file, "table line " + std::to_string(number), "expected a closing quote, got the end");
    }
    ++at;
  }
  return lines;
}

void makeFolder(const char* option, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) throw InputError(option, folder, "expected a folder, or a place for one");
}

}  // namespace radar::tools
