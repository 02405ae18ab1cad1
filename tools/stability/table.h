// What the stability suite found, as tables.
#pragma once

#include <string>
#include <vector>

#include "stability/changes.h"
#include "stability/measure.h"
#include "stability/steps.h"

namespace radar::tools {

/// The sums over all families of each way of asking, as rows of the family `all`: counts added up, the worst of the
/// worst.
std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows);
std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows);

/// A header, then a line for each row.
std::string csvOf(const std::vector<StabilityRow>& rows);
std::string csvOf(const std::vector<StepRow>& rows);
std::string csvOf(const std::vector<ChangeRow>& rows);
/// What each family varies: its parameter and the values.
std::string csvOf(const std::vector<HardFamily>& families);

/// For the terminal.
std::string tableOf(const std::vector<StabilityRow>& rows);

}  // namespace radar::tools
