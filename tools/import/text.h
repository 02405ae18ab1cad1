// The text of a mesh file, taken token by token or line by line.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "import/input_error.h"
#include "import/number_text.h"

namespace radar::tools {

inline constexpr std::string_view kBlanks = " \t\r\n";

/// `file` names the file in messages. It and the text must outlive this.
class Text {
 public:
  Text(const std::string& file, std::string_view text, size_t line = 1) : file_(&file), rest_(text), line_(line) {}

  bool atEnd() const { return rest_.empty(); }
  /// What stands up to the next blank; empty at the end.
  std::string_view token() {
    drop(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view found = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(found.size());
    return found;
  }
  /// The rest of the line, without its end. Goes to the next line.
  std::string_view lineOfText() {
    const std::string_view found = rest_.substr(0, rest_.find('\n'));
    drop(std::min(found.size() + 1, rest_.size()));
    return found.ends_with('\r') ? found.substr(0, found.size() - 1) : found;
  }
  /// Throws unless `word` is a number, be it no finite one, that is in the range of floats.
  double coordinate(std::string_view word) const { return known(radar::tools::coordinate(word), word); }
  /// The same for doubles.
  double number(std::string_view word) const { return known(nearest<double>(word), word); }
  /// False if fewer bytes are left.
  bool skipBytes(uint64_t count) {
    if (rest_.size() < count) return false;
    rest_.remove_prefix(count);
    return true;
  }
  std::string_view rest() const { return rest_; }
  const std::string& file() const { return *file_; }
  /// Where the next token or line begins, from 1.
  size_t line() const { return line_; }

  /// Throws "FILE: line N: expected `what`, got "`word`"".
  [[noreturn]] void expected(const std::string& what, std::string_view word) const {
    refuse("line " + std::to_string(line_),
           "expected " + what + (word.empty() ? ", got nothing" : ", got \"" + printable(word, 60) + "\""));
  }
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const {
    throw InputError(*file_, place, problem);
  }

 private:
  double known(const std::optional<double>& value, std::string_view word) const {
    if (!value) expected("a number in the range of floats", word);
    return *value;
  }
  void drop(size_t count) {
    line_ += std::count(rest_.begin(), rest_.begin() + count, '\n');
    rest_.remove_prefix(count);
  }

  const std::string* file_;
  std::string_view rest_;
  size_t line_;
};

}  // namespace radar::tools
