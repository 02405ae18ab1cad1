#include "import/input_error.h"

#include <bit>
#include <charconv>
#include <cmath>

namespace radar::tools {

namespace {

/// The bytes of the UTF-8 character that the text begins with; 0 if it begins with none, or with a control character.
size_t characterLength(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7f;
  const auto length = static_cast<size_t>(std::countl_one(byte(0)));
  if (length < 2 || length > 4 || length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 2) return 0;
  }
  return byte(0) == 0xc2 && byte(1) < 0xa0 ? 0 : length;
}

}  // namespace

std::string counted(uint64_t count, const std::string& one, const std::string& several) {
  return std::to_string(count) + " " + (count == 1 ? one : several.empty() ? one + "s" : several);
}

std::string inShortest(double number) {
  if (std::isnan(number)) return "nan";  // of either sign
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

std::string printable(std::string_view text, size_t most) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    if (result.size() >= most) return result + "...";
    const size_t length = characterLength(text);
    if (length == 0) {
      const auto byte = static_cast<uint8_t>(text[0]);
      result.append("\\x").append({kDigits[byte >> 4], kDigits[byte & 15]});
    }
    result.append(text.substr(0, length));
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

}  // namespace radar::tools
