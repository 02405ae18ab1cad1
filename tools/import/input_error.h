#pragma once

#include <stdexcept>
#include <string>

namespace radar::tools {

/// Input that breaks its contract: "FILE: PLACE: expected ..., got ...". PLACE is empty where the file as a whole is
/// meant.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, const std::string& place, const std::string& problem)
      : std::runtime_error(file + ": " + (place.empty() ? "" : place + ": ") + problem) {}
};

}  // namespace radar::tools
