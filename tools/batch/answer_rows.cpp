#include "batch/answer_rows.h"

#include <cstring>
#include <stdexcept>

#include "batch/columns.h"
#include "batch/json_output.h"

namespace radar::tools {

namespace {

constexpr std::string_view kLineStart = "{\"id\": ";

// The length of the JSON string that `text` begins with, its quotes included; 0 if there is none.
size_t stringLength(std::string_view text) {
  if (!text.starts_with('"')) return 0;
  for (size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      return i + 1;
    }
  }
  return 0;
}

constexpr size_t kStatusPlace = 152;  // in a record

}  // namespace

const char* nameOf(AnswerFormat format) {
  return format == AnswerFormat::lines ? "lines" : "records";
}

AnswerFormat answerFormatFrom(std::string_view name) {
  for (const AnswerFormat format : {AnswerFormat::lines, AnswerFormat::records}) {
    if (name == nameOf(format)) return format;
  }
  throw std::invalid_argument("expected lines or records, got \"" + std::string(name) + "\"");
}

AnswerFormat answerFormatOf(const std::filesystem::path& file) {
  return file.extension() == ".npy" ? AnswerFormat::records : AnswerFormat::lines;
}

std::string AnswerRows::text(uint64_t first, std::span<const QuerySpec> queries, std::span<const Answer> answers) {
  std::string rows;
  if (format_ == AnswerFormat::records) {
    for (size_t i = 0; i < queries.size(); ++i) appendRecord(rows, first + i, queries[i], answers[i]);
    return rows;
  }
  for (size_t i = 0; i < queries.size(); ++i) {
    const uint32_t scene = queries[i].scene;
    auto names = names_.find(scene);
    if (names == names_.end()) names = names_.emplace(scene, world_.objectNames(scene)).first;
    rows += answerLine(queries[i], answers[i], names->second) + "\n";
  }
  return rows;
}

std::string startOf(AnswerFormat format, uint64_t queries) {
  return format == AnswerFormat::lines ? "" : npyHeader(recordDescription(), queries, kRecordsStart);
}

size_t rowLength(AnswerFormat format, std::string_view rows) {
  if (format == AnswerFormat::records) return rows.size() < kRecordLength ? 0 : kRecordLength;
  return rows.find('\n') + 1;  // npos + 1 is 0
}

bool isRow(AnswerFormat format, std::string_view row, uint64_t index, const QuerySpec* query) {
  if (format == AnswerFormat::records) return std::memcmp(row.data(), &index, sizeof index) == 0;
  if (!row.starts_with(kLineStart) || !row.ends_with("}\n")) return false;
  row.remove_prefix(kLineStart.size());
  return query ? row.starts_with(quoted(query->id) + ", ") : stringLength(row) > 0;
}

std::optional<Status> statusOfRow(AnswerFormat format, std::string_view row) {
  constexpr std::string_view kBefore = ", \"status\": \"";
  if (format == AnswerFormat::lines) {
    row.remove_prefix(kLineStart.size());
    row.remove_prefix(stringLength(row));
    if (!row.starts_with(kBefore)) return std::nullopt;
    row.remove_prefix(kBefore.size());
  }
  for (uint8_t code = 0; code <= static_cast<uint8_t>(Status::invalid); ++code) {
    const auto status = static_cast<Status>(code);
    if (format == AnswerFormat::records ? static_cast<uint8_t>(row[kStatusPlace]) == code
                                        : row.starts_with(nameOf(status) + std::string("\""))) {
      return status;
    }
  }
  return std::nullopt;
}

}  // namespace radar::tools
