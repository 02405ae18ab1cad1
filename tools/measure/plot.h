// Charts, drawn by gnuplot (https://www.gnuplot.info) in a child process.
#pragma once

#include <string>
#include <vector>

#include "measure/report.h"

namespace radar::tools {

/// The gnuplot scripts of this folder, as text. Their first lines name their arguments.
extern const char *const kFrontScript, *const kLinesScript;

/// The SVG file that a script draws of a table. `texts`: the script's arguments after it, taken literally. Throws
/// std::runtime_error if gnuplot is missing or too old, or if the script fails.
std::string plot(const char* script, Json table, const std::vector<std::string>& texts);

/// Draws into the folder, and names the chart in a report's part.
void drawFor(Json& part, const std::filesystem::path& folder, const std::string& name, const std::string& svg);

/// Throws as plot() does if gnuplot is missing or too old. Call it before work whose results would be lost.
void requireGnuplot();
/// What requireGnuplot() would say; empty if gnuplot can draw.
std::string whyUndrawn();

}  // namespace radar::tools
