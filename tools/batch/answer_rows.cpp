#include "batch/answer_rows.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "batch/columns.h"
#include "batch/json_output.h"
#include "import/input_error.h"
#include "workloads/query_fields.h"

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

// The length of a table's first cell or row, up to what ends it, or npos.
size_t untilEnd(std::string_view text, char end) {
  bool isQuoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') isQuoted = !isQuoted;
    if (text[i] == end && !isQuoted) return i;
  }
  return text.npos;
}

struct Format {
  AnswerFormat format;
  const char *name, *ending;
};
constexpr Format kFormats[] = {{AnswerFormat::lines, "lines", ""},
                               {AnswerFormat::records, "records", ".npy"},
                               {AnswerFormat::table, "table", ".csv"}};

}  // namespace

const char* nameOf(AnswerFormat format) {
  return kFormats[static_cast<size_t>(format)].name;
}

AnswerFormat answerFormatFrom(std::string_view name) {
  for (const Format& format : kFormats) {
    if (name == format.name) return format.format;
  }
  throw std::invalid_argument("expected lines, records or table, got \"" + std::string(name) + "\"");
}

AnswerFormat answerFormatOf(const std::filesystem::path& file) {
  for (const Format& format : kFormats) {
    if (*format.ending != 0 && file.extension() == format.ending) return format.format;
  }
  return AnswerFormat::lines;
}

AnswerFormat readFormatOf(const std::filesystem::path& file) {
  const AnswerFormat format = answerFormatOf(file);
  if (format != AnswerFormat::table) return format;
  throw InputError(file.string(), "", "expected lines of JSON, or records in a file .npy, got a table");
}

const char* endingOf(AnswerFormat format) {
  return kFormats[static_cast<size_t>(format)].ending;
}

void requireRoom(const std::filesystem::path& file, const ModesAsked& asked) {
  const AnswerFormat format = answerFormatOf(file);
  const auto refuse = [&](const std::string& what, const std::string& query) {
    throw InputError("--out", file.string(),
                     std::string("expected another file than ") + endingOf(format) + ", as answers " + what +
                         " (query \"" + query + "\")");
  };
  if (format == AnswerFormat::records && asked.moved) refuse("of a \"chain\" name links", *asked.moved);
  if (format == AnswerFormat::lines || !asked.listed) return;
  std::string options;
  for (const QueryField& field : queryFields()) {
    if (field.lists) options.append(options.empty() ? "\"" : "\" or \"").append(field.name);
  }
  refuse("with " + options + "\" have lists", *asked.listed);
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
    if (names == names_.end()) names = names_.emplace(scene, AnswerNames{.objects = world_.objectNames(scene)}).first;
    if (format_ == AnswerFormat::table) {
      rows += tableRow(queries[i], answers[i], names->second.objects);
    } else {
      if (queries[i].chain) names->second.links = world_.chains[queries[i].chain->chain].linkNames;
      rows += answerLine(queries[i], answers[i], names->second) + "\n";
    }
  }
  return rows;
}

std::string startOf(AnswerFormat format, uint64_t queries) {
  if (format == AnswerFormat::table) return tableHead();
  return format == AnswerFormat::lines ? "" : npyHeader(recordDescription(), queries, kRecordsStart);
}

size_t rowLength(AnswerFormat format, std::string_view rows) {
  if (format == AnswerFormat::records) return rows.size() < fileLayout().size ? 0 : fileLayout().size;
  return (format == AnswerFormat::table ? untilEnd(rows, '\n') : rows.find('\n')) + 1;  // npos + 1 is 0
}

bool isRow(AnswerFormat format, std::string_view row, uint64_t index, const QuerySpec* query) {
  if (format == AnswerFormat::records) return std::memcmp(row.data(), &index, sizeof index) == 0;
  if (format == AnswerFormat::table)
    return query ? row.starts_with(cell(query->id) + ",") : untilEnd(row, ',') < row.size();
  if (!row.starts_with(kLineStart) || !row.ends_with("}\n")) return false;
  row.remove_prefix(kLineStart.size());
  return query ? row.starts_with(quoted(query->id) + ", ") : stringLength(row) > 0;
}

std::optional<Status> statusOfRow(AnswerFormat format, std::string_view row) {
  constexpr std::string_view kBefore = ", \"status\": \"";
  const AnswerField& field = *findAnswerField("status");
  if (format == AnswerFormat::lines) {
    row.remove_prefix(kLineStart.size());
    row.remove_prefix(stringLength(row));
    if (!row.starts_with(kBefore)) return std::nullopt;
    row.remove_prefix(kBefore.size());
    row = row.substr(0, row.find('"'));
  } else if (format == AnswerFormat::table) {
    row.remove_prefix(std::min(row.size(), untilEnd(row, ',') + 1));
    row = row.substr(0, row.find(','));
  }
  const double code = format == AnswerFormat::records ? row[field.place] : codeOf(field, row);
  if (!(code >= 0 && code < static_cast<double>(field.words.size()))) return std::nullopt;
  return static_cast<Status>(static_cast<uint32_t>(code));
}

}  // namespace radar::tools
