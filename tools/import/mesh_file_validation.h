// Assimp accepts PLY and OFF files that end early or name vertices that do not exist, and fills in what is missing.
#pragma once

#include <filesystem>

namespace radar::tools {

/// Throws InputError, naming the element or line, if a PLY or OFF file holds less than its header promises, or an OFF
/// face that assimp would leave out or bend. Files of other kinds pass.
void requireIntact(const std::filesystem::path& file);

}  // namespace radar::tools
