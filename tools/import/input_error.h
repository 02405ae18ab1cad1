#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace radar::tools {

/// `text` for a message: control characters and what is no UTF-8 as \xNN, cut short after about `most` bytes.
std::string printable(std::string_view text, size_t most = 1000);

/// The shortest decimal number that reads back as the same double; "nan", "inf".
std::string inShortest(double number);

/// "1 scene", "2 scenes"; `several`: where that is not the word with an s.
std::string counted(uint64_t count, const std::string& one, const std::string& several = "");

/// Input that breaks its contract: "FILE: PLACE: expected ..., got ...", each printable. PLACE is empty where the file
/// as a whole is meant.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, const std::string& place, const std::string& problem)
      : std::runtime_error(printable(file) + ": " + (place.empty() ? "" : printable(place, 200) + ": ") +
                           printable(problem)) {}
  /// With the words of another InputError.
  explicit InputError(const std::string& words) : std::runtime_error(words) {}
};

}  // namespace radar::tools
