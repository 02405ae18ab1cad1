// Reads answer files.
#pragma once

#include <filesystem>
#include <vector>

#include "batch/answer_file.h"
#include "batch/columns.h"
#include "import/json_input.h"

namespace radar::tools {

/// A member of a line, or of a contact in its list, as a number: NaN for null, or where it is missing; a code's.
double memberIn(const JsonValue& object, const AnswerField& field, size_t part = 0);
/// The same of a record.
double memberIn(const Columns& records, uint64_t row, const AnswerField& field, size_t part = 0);

/// The answers to a workload's queries, as cyber-radar query wrote them: lines, or records in a file .npy. Throws
/// InputError that names file and row if they are not of these queries.
std::vector<Answer> readAnswers(const std::filesystem::path& file, const Workload& workload);

}  // namespace radar::tools
