// What the stability suite found, as tables.
#pragma once

#include "report/tables.h"
#include "stability/changes.h"
#include "stability/measure.h"
#include "stability/steps.h"

namespace radar::tools {

/// The sums over all families of each way of asking, as rows of the family `all`: counts added up, the worst of the
/// worst.
std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows);
std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows);

Json tableOf(const std::vector<StabilityRow>& rows);
Json tableOf(const std::vector<StepRow>& rows);
Json tableOf(const std::vector<ChangeRow>& rows);
/// What each family varies: its parameter and the values.
Json tableOf(const std::vector<HardFamily>& families);

}  // namespace radar::tools
