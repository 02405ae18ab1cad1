// Charts, drawn by gnuplot (https://www.gnuplot.info) in a child process.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace radar::tools {

/// The gnuplot scripts of this folder, as text. Their first lines name their arguments.
extern const char *const kStyleScript, *const kFrontScript, *const kTimesScript, *const kScaleScript;

/// The SVG file that a script draws from a CSV file. `texts`: the script's further arguments, taken literally.
/// Throws std::runtime_error if gnuplot is missing or too old, or if the script fails.
std::string plot(const char* script, const std::filesystem::path& csv, const std::vector<std::string>& texts);

/// Throws as plot() does if gnuplot is missing or too old. Call it before work whose results would be lost.
void requireGnuplot();

}  // namespace radar::tools
