// Rows of the stability suite as tables.
#pragma once

#include <string>
#include <vector>

#include "stability/measure.h"

namespace radar::tools {

/// Each method and resolution over all families: counts added up, the worst of the worst, medians of medians.
std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows);

std::string csvOf(const std::vector<StabilityRow>& rows);
/// For the terminal.
std::string tableOf(const std::vector<StabilityRow>& rows);
std::string markdownOf(const std::vector<StabilityRow>& rows);

}  // namespace radar::tools
