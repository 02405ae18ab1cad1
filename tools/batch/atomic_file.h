// Output files that are either complete or absent.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace radar::tools {

/// Writes `content` beside `file` and renames it into place. Throws std::runtime_error that names the file; the old
/// file is then untouched and no unfinished file stays.
void writeAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace radar::tools
