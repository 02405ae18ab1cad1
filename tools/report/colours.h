// The colours of pages and charts, which have the same names: page, ink, soft, grid, panel, and c0 to c7 of lines.
#pragma once

#include <string>
#include <string_view>

namespace radar::tools {

/// "#0072b2", on a light page.
std::string_view lightColour(std::string_view name);

/// CSS that gives each var(--name) its colour, light or dark as the reader's screen is.
std::string colourVariables();

/// CSS that turns charts, which gnuplot draws in the light colours, dark where the reader's screen is.
std::string darkChartRules();

}  // namespace radar::tools
