// Text in markup.
#pragma once

#include <string>
#include <string_view>

namespace radar::tools {

/// For text and attributes.
std::string escaped(std::string_view text);

/// The start of an SVG element that tells its title.
std::string openSvg(const std::string& attributes, const std::string& title);

}  // namespace radar::tools
