// A fuzz target: a function that takes any bytes. It must neither crash, hang nor leak, and throws if a check of its
// own fails.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace radar::fuzz {

struct Target {
  void (*run)(std::string_view input);
  /// Inputs from which mutations start.
  std::vector<std::string> (*seeds)();
  /// Words that mutations insert.
  std::vector<std::string> words;
};

/// Each target is a program of its own, whose file defines this.
const Target& target();

/// Throws `what` unless `holds`.
inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// So many seeds of random bytes, for targets that take every byte for a choice.
std::vector<std::string> randomSeeds(size_t count, size_t bytes);

/// Words with '~' between them.
std::vector<std::string> separated(std::string_view words);

}  // namespace radar::fuzz
