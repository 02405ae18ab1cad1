#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace radar::tools {

/// Lines from a pipe, a terminal or a file, as they come.
class LineInput {
 public:
  /// `descriptor` stays open; `name` is for messages.
  LineInput(int descriptor, std::string name);

  /// Waits for a line and returns all that can be had without waiting, as far as 4 MiB go, without their ends; none at
  /// the end of the input, whose last line may have no end. Throws InputError, "NAME: ..." or "NAME:17: ..." with a
  /// line's number from 1, if the input cannot be read or a line has more than 64 MiB.
  std::vector<std::string> next();
  /// "NAME:17", the place of a line that next() returned last, by its index there.
  std::string placeOf(size_t index) const { return name_ + ":" + std::to_string(before_ + index + 1); }

 private:
  void read();
  bool hasMore() const;

  int descriptor_;
  std::string name_, rest_;
  std::vector<char> room_;
  size_t before_ = 0, last_ = 0;  ///< lines before those that next() returned last; how many these were
  bool isEnd_ = false;
};

}  // namespace radar::tools
