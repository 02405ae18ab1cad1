#include "bench/csv.h"

#include <charconv>
#include <cmath>

#include "import/input_error.h"

namespace radar::bench {

std::string csvLine(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    if (cell.find_first_of(",\"\n#") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\n";
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
      throw tools::InputError(file, "table line " + std::to_string(number), "expected a closing quote, got the end");
    }
    ++at;
  }
  return lines;
}

std::string csvNumber(double value) {
  if (std::isnan(value)) return "";
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace radar::bench
