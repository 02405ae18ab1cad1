// Rows of the stability suite as tables.
#pragma once

#include <string>
#include <vector>

#include "stability/changes.h"
#include "stability/measure.h"
#include "stability/steps.h"

namespace radar::tools {

/// "sampled 64", "contact".
std::string tierOf(const StabilityRow& row);

/// Each method and resolution over all families: counts added up, the worst of the worst, medians of medians.
std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows);
/// Each method over all families.
std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows);

/// A header, then a line for each row.
std::string csvOf(const std::vector<StabilityRow>& rows);
std::string csvOf(const std::vector<StepRow>& rows);
std::string csvOf(const std::vector<ChangeRow>& rows);
/// What each family varies: its parameter and the values.
std::string csvOf(const std::vector<StabilityFamily>& families);

/// For the terminal.
std::string tableOf(const std::vector<StabilityRow>& rows);

}  // namespace radar::tools
