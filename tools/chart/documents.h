// A run for people: the two documents in the repository. drawings.h draws their charts.
#pragma once

#include <filesystem>
#include <string>

#include "chart/record.h"

namespace radar::tools {

/// Markdown. `charts`: the folder of the charts, from the document's place.
std::string accuracyDocument(const Record& record, const std::string& charts);
std::string performanceDocument(const Record& record, const std::string& charts);

/// accuracy.md and performance.md into `folder`, pointing to the charts in `charts`.
void writeDocuments(const std::filesystem::path& folder, const std::filesystem::path& charts, const Record& record);

}  // namespace radar::tools
