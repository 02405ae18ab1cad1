// Output files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace radar::tools {

/// Writes `content` beside `file` and renames it into place. Throws std::runtime_error that names the file; what was
/// there before is then untouched and nothing half-written stays.
void writeAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace radar::tools
