// Answers as lines of JSON, and as records.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

struct Answer {
  Result result;
  AnswerMode mode = AnswerMode::reference;
  std::string reason;  ///< why the status is invalid
  Listed listed;
};

/// One line, without its end. All keys of the format are there, with null for what the answer does not have;
/// `paper_min_l` only in mode sampled, `time` only where the query gives a speed, `reason` only where the status is
/// invalid, `hits` and `overlapping` only where the query asks for them, `object_name` and `overlapping_names` only
/// with `objectNames`, which are Workload::objectNames of the query's scene.
std::string answerLine(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames = {});

/// The same as a record of numpy's, whose type recordDescription() says; NaN and -1 for null.
inline constexpr size_t kRecordLength = 160;
void appendRecord(std::string& records, uint64_t index, const QuerySpec& query, const Answer& answer);
std::string recordDescription();

const char* nameOf(Status status);
/// Throws std::invalid_argument that lists the names.
Status statusFrom(std::string_view name);
const char* nameOf(Tier tier);
const char* nameOf(Feature feature);

}  // namespace radar::tools
