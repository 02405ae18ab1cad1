// docs/stability.md: what matters of a run; the rows are in the tables of table.h.
#pragma once

#include <string>
#include <vector>

#include "stability/changes.h"
#include "stability/measure.h"
#include "stability/steps.h"

namespace radar::tools {

/// A picture of one telling case; its file is named relative to the page.
struct StabilityPicture {
  std::string file, title, words;
};

/// All that a run found.
struct StabilityFindings {
  StabilityReport report;
  std::vector<StepRow> steps;
  std::vector<ChangeRow> changes;
  std::vector<StabilityPicture> pictures;
};

struct StabilityOrigin {
  std::string command, commit, date, device, driver;
};

std::string pageOf(const StabilityFindings& findings, const StabilityOrigin& origin);

}  // namespace radar::tools
