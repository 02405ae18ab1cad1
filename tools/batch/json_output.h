// JSON as the files of this folder hold it: each object in one line, numbers that read back with the same bits.
#pragma once

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace radar::tools {

/// The shortest decimal number that reads back as the same double; "null" for NaN and infinities.
inline void appendNumber(std::string& text, double value) {
  char digits[32];
  if (std::isfinite(value)) {
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  } else {
    text += "null";
  }
}

inline std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// "[a,b,c]", each element appended by `append`.
template <class List, class Append>
std::string listOf(const List& list, const char* separator, const Append& append) {
  std::string text = "[";
  for (const auto& element : list) {
    if (text.size() > 1) text += separator;
    append(text, element);
  }
  return text + "]";
}

/// An object's members, in the order in which they are added.
class JsonObject {
 public:
  void add(const char* key, const std::string& json) { begin(key) += json; }
  void addString(const char* key, const std::string& value) { add(key, quoted(value)); }
  void addNumber(const char* key, double value) { appendNumber(begin(key), value); }
  /// Begins a member, whose value is to be appended to what this returns.
  std::string& begin(const char* key) {
    return text_.append(text_.empty() ? "{\"" : ", \"").append(key).append("\": ");
  }
  std::string text() const { return text_ + "}"; }

 private:
  std::string text_;
};

}  // namespace radar::tools
