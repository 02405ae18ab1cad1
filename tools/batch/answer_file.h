// Answers as lines of JSON, as rows of a table, and as records.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "workloads/answer_fields.h"

namespace radar::tools {

struct Answer {
  Result result;
  AnswerMode mode = AnswerMode::reference;
  std::string reason;  ///< why the status is invalid
  Listed listed;
  LinksMet links{};  ///< of a chain
};

/// What a query's scene and its chain call their objects and links.
struct AnswerNames {
  std::vector<std::string> objects{};  ///< Workload::objectNames
  std::span<const std::string> links{};
};

/// One line, without its end. All keys of the format are there, with null for what the answer does not have;
/// `reason` only where the status is invalid, `hits`, `overlapping`, `closest` and `exit` only where the query asks for
/// them, `object_name` and `overlapping_names` only where objects have names.
std::string answerLine(const QuerySpec& query, const Answer& answer, const AnswerNames& names = {});

/// The same as a row of comma-separated values (RFC 4180, but lines end as lines do), under this head; both with their
/// ends. Empty for null.
std::string tableHead();
std::string tableRow(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames);
/// In quotes if it holds what ends a cell.
std::string cell(const std::string& text);

/// The same as a record of numpy's, whose type recordDescription() says; NaN and -1 for null.
void appendRecord(std::string& records, uint64_t index, const QuerySpec& query, const Answer& answer);
std::string recordDescription();

}  // namespace radar::tools
