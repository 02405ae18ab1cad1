// Answers as the rows of a file: lines of JSON, of a table, or records of one size.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "batch/answer_file.h"
#include "batch/query_file.h"

namespace radar::tools {

enum class AnswerFormat {
  lines,    ///< JSON Lines
  records,  ///< in an .npy file
  table     ///< comma-separated values in a .csv file
};
const char* nameOf(AnswerFormat format);
/// Throws std::invalid_argument that lists the names.
AnswerFormat answerFormatFrom(std::string_view name);
/// What an answer file with this name is written in.
AnswerFormat answerFormatOf(const std::filesystem::path& file);
/// The same of one to be read. Throws InputError if it is a table, which only other programs read.
AnswerFormat readFormatOf(const std::filesystem::path& file);
/// How its name ends; of lines, in any other way.
const char* endingOf(AnswerFormat format);
/// Throws InputError if a file of that format cannot hold what queries ask for: the lists of some, or the links of
/// chains.
void requireRoom(const std::filesystem::path& file, const ModesAsked& asked);

/// Makes the rows of one workload's answers. A row depends on its query and its answer alone.
class AnswerRows {
 public:
  /// `world` has the scenes, and outlives this.
  AnswerRows(const Workload& world, AnswerFormat format) : world_(world), format_(format) {}
  /// The rows of consecutive queries, each with its end; the first query has the index `first`.
  std::string text(uint64_t first, std::span<const QuerySpec> queries, std::span<const Answer> answers);

 private:
  const Workload& world_;
  AnswerFormat format_;
  std::map<uint32_t, AnswerNames> names_;  ///< by scene, of those met so far; links are the last chain's
};

/// What stands before the rows of all answers: nothing before lines, a head before a table's, kRecordsStart bytes
/// before records.
inline constexpr size_t kRecordsStart = 2048;
std::string startOf(AnswerFormat format, uint64_t queries);
/// The length of the first row of `rows`, its end included; 0 if it is cut off.
size_t rowLength(AnswerFormat format, std::string_view rows);
/// Whether a row is that of the query with this index, as far as a row says; `query`: that query, if at hand.
bool isRow(AnswerFormat format, std::string_view row, uint64_t index, const QuerySpec* query);
/// What a row says; none if it is damaged there.
std::optional<Status> statusOfRow(AnswerFormat format, std::string_view row);

}  // namespace radar::tools
