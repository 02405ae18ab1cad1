// Files that end: a device or a pipe might be read for ever.
#pragma once

#include <filesystem>
#include <string>

namespace radar::tools {

/// Throws InputError "FILE: expected `kind`, got ..." if this is no regular file or a link to one.
void requireRegular(const std::filesystem::path& file, const char* kind);

/// The content of such a file. Throws InputError, too, if it cannot be read.
std::string readRegularFile(const std::filesystem::path& file, const char* kind);

}  // namespace radar::tools
