// Query files, format cyber-radar-queries-1.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "import/input_error.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Reads a query file with its meshes and instance files; "-" is standard input, in the current folder. Everything is
/// checked: what is returned keeps the contracts of radar::Scene and radar::Query. Throws InputError that names the
/// file, the JSON path (or line) and what was expected. Appends the warnings about mesh files to `warnings`.
Workload readQueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Writes `folder`/queries.json, the meshes as binary PLY, whose floats are exact, and a scene of more than 64
/// instances as an instance file; makes the folder. Reading it gives the same workload to the bit (a mesh's name is its
/// file's then, and names of objects are not kept). Returns the query file. Throws std::runtime_error if something
/// cannot be written.
std::filesystem::path writeQueryFile(const Workload& workload, const std::filesystem::path& folder);

/// Whether a query asks for what mode sampled does not offer; and what to use instead.
bool needsExactMode(const Workload& workload, const QuerySpec& query);
inline constexpr const char* kExactModes =
    "contact or reference, as \"ignore_leaving\", \"skip_overlapping\", \"clearance\", several \"hits\" and motions "
    "need";

/// The words of a mode in files and options. modeFrom throws std::invalid_argument that lists them.
const char* nameOf(AnswerMode mode);
AnswerMode modeFrom(std::string_view name);

}  // namespace radar::tools
