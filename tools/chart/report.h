// A run for people: a page, and the two documents in the repository.
#pragma once

#include <filesystem>
#include <string>

#include "chart/record.h"

namespace radar::tools {

/// One page with all it needs: charts and findings.
std::string pageOf(const Record& record);

/// Markdown. `charts`: the folder of the charts, from the document's place.
std::string accuracyDocument(const Record& record, const std::string& charts);
std::string performanceDocument(const Record& record, const std::string& charts);

/// The page as chart.html, and each chart as SVG and PNG, into `folder`.
void writeReport(const std::filesystem::path& folder, const Record& record);
/// accuracy.md and performance.md into `folder`, pointing to the charts in `charts`.
void writeDocuments(const std::filesystem::path& folder, const std::filesystem::path& charts, const Record& record);

}  // namespace radar::tools
