// Answer files: JSON Lines, one line per query.
#pragma once

#include <string>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

/// One line, without its end. All keys of the format are there, with null for what the answer does not have;
/// `paper_min_l` only in mode sampled, `time` only where the query gives a speed, `reason` only where the status is
/// invalid.
std::string answerLine(const QuerySpec& query, const Result& result, AnswerMode mode, const std::string& reason);

const char* nameOf(Status status);
const char* nameOf(Tier tier);

}  // namespace radar::tools
