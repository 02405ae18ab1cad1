// Colours, and the rules by which charts use them.
#pragma once

#include <string>

namespace radar::tools {

/// The rules of inline charts. Colours are written var(--name).
std::string chartRules();
/// Gives the names their colours, light or dark as the reader's screen is.
std::string colourVariables();
/// The rules with the colours put in, for a chart outside a page.
std::string standaloneRules();

}  // namespace radar::tools
