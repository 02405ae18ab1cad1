// A chart as a file of its own.
#pragma once

#include <filesystem>
#include <string>

namespace radar::tools {

/// The chart as a whole SVG file, light or dark as its reader's screen is.
std::string standalone(const std::string& svg);

/// Writes FOLDER/NAME.svg and, drawn light by librsvg, FOLDER/NAME.png, 1240 pixels wide. Throws std::runtime_error
/// that names the file.
void writePicture(const std::filesystem::path& folder, const std::string& name, const std::string& svg);

}  // namespace radar::tools
