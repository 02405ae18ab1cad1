#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace radar::tools {

/// "; did you mean ...?", if one of the known words is near; else nothing.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace radar::tools
