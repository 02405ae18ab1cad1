// Reads answer files.
#pragma once

#include <filesystem>
#include <vector>

#include "batch/answer_file.h"

namespace radar::tools {

/// The answers to a workload's queries, as cyber-radar query wrote them: lines, or records in a file .npy. Reads all
/// but what only some answers have: features, tier, detected and paper_min_l. Throws InputError that names file
/// and row if they are not of these queries.
std::vector<Answer> readAnswers(const std::filesystem::path& file, const Workload& workload);

}  // namespace radar::tools
