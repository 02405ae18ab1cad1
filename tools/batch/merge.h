// Joins what shards answered.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace radar::tools {

/// Writes the answer file of a query file whose shards' answer files are given, in any order. Returns whether every
/// query was answered. Throws InputError if the files do not belong together, one is given twice, incomplete or
/// damaged, or shards are missing, which the message names, or if
/// the name of `out` is for another format than theirs; `out` is then untouched.
bool mergeShards(const std::vector<std::string>& files, const std::filesystem::path& out);

}  // namespace radar::tools
