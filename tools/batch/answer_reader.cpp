#include "batch/answer_reader.h"

#include <cmath>
#include <functional>

#include "batch/answer_rows.h"
#include "batch/columns.h"
#include "batch/mapped_file.h"
#include "import/json_input.h"

namespace radar::tools {

namespace {

/// One row of a file, whose members have the names that lines give them.
struct RowReader {
  std::string place;  ///< for messages
  const QuerySpec& query;
  std::function<double(const char* name, size_t part)> number;  ///< NaN for null
};

uint32_t idIn(const RowReader& row, const char* name, uint64_t limit, const std::string& file) {
  const double value = row.number(name, 0);
  if (std::isnan(value)) return kNone;
  if (value >= 0 && value < static_cast<double>(limit)) return static_cast<uint32_t>(value);
  throw InputError(file, row.place + ": " + name,
                   "expected a whole number below " + std::to_string(limit) + ", got " + inShortest(value));
}

Result resultOf(const RowReader& row, Status status, const Workload& workload, const std::string& file) {
  Result result(status);
  const QuerySpec& query = row.query;
  const auto read = [&](double& to, const char* distance, const char* fraction) {
    const double value = row.number(query.motion ? fraction : distance, 0);
    if (!std::isnan(value)) to = value;
  };
  read(result.t, "t", "fraction");
  read(result.lo, "lo", "fraction_lo");
  read(result.hi, "hi", "fraction_hi");
  result.object = idIn(row, "object", workload.objectCount(query.scene), file);
  result.triA = idIn(row, "tri_a", workload.meshes[query.mesh].triangleCount(), file);
  if (result.object != kNone) {
    const uint32_t touched = workload.instance(query.scene, result.object).mesh;
    result.triB = idIn(row, "tri_b", workload.meshes[touched].triangleCount(), file);
  }
  const bool touches = result.object != kNone && (status == Status::hit || status == Status::overlap);
  result.gap = query.clearance > 0 ? row.number("gap", 0) : touches ? 0 : double{NAN};
  for (size_t k = 0; k < 3; ++k) {
    result.point[k] = row.number("point", k);
    result.normal[k] = row.number("normal", k);
  }
  return result;
}

/// The members of a line, or of a contact in its list.
RowReader membersOf(const JsonValue& from, const std::string& place, const QuerySpec& query) {
  return {place, query, [from](const char* name, size_t part) {
            if (!from.has(name) || from.member(name).json().is_null()) return double{NAN};
            const JsonValue value = from.member(name);
            if (!value.json().is_array()) return value.number();
            if (value.size() != 3) value.expected("three numbers");
            return value[part].json().is_null() ? NAN : value[part].number();  // too large for a double
          }};
}

/// A contact in a list, which has no status of its own, and none of `fraction`.
Result contactOf(const RowReader& row, const Workload& workload, const std::string& file) {
  const double hi = row.number(row.query.motion ? "fraction_hi" : "hi", 0);
  const Status status = std::isnan(hi) ? Status::undecided : hi == 0 ? Status::overlap : Status::hit;
  Result contact = resultOf(row, status, workload, file);
  if (row.query.motion && status != Status::undecided) contact.t = contact.lo;
  return contact;
}

[[noreturn]] void refuseCount(const std::string& file, uint64_t expected, uint64_t got) {
  throw InputError(file, "",
                   "expected " + counted(expected, "answer") + ", one for each query, got " + std::to_string(got));
}

std::vector<Answer> readLines(const std::string& file, std::string_view text, const Workload& workload) {
  std::vector<Answer> answers;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (answers.size() == workload.queries.size()) refuseCount(file, workload.queries.size(), answers.size() + 1);
    const QuerySpec& query = workload.queries[answers.size()];
    const std::string place = "line " + std::to_string(answers.size() + 1), where = file + ": " + place;
    const nlohmann::json json = parseJson(where, line);
    const JsonValue root(where, json);
    if (const std::string id = root.member("id").string(); id != query.id) {
      throw InputError(file, place, "expected the answer to query \"" + query.id + "\", got that to \"" + id + "\"");
    }
    const RowReader row = membersOf(root, place, query);
    Answer& answer = answers.emplace_back();
    const JsonValue status = root.member("status");
    answer.result = resultOf(row, status.guard([&] { return statusFrom(status.string()); }), workload, file);
    root.ifHas("hits", [&](const JsonValue& list) {
      list.forEach([&](const JsonValue& hit) {
        hit.member("object").index(workload.objectCount(query.scene), "objects");
        const std::string at = place + ": hits[" + std::to_string(answer.listed.hits.size()) + "]";
        answer.listed.hits.push_back(contactOf(membersOf(hit, at, query), workload, file));
      });
    });
    root.ifHas("overlapping", [&](const JsonValue& list) {
      const size_t objects = workload.objectCount(query.scene);
      list.forEach(
          [&](const JsonValue& object) { answer.listed.overlapping.push_back(object.index(objects, "objects")); });
    });
    root.ifHas("reason", [&](const JsonValue& reason) { answer.reason = reason.string(); });
    if (root.has("paper_min_l")) answer.mode = AnswerMode::sampled;
  }
  if (answers.size() < workload.queries.size()) refuseCount(file, workload.queries.size(), answers.size());
  return answers;
}

std::vector<Answer> readRecords(const std::string& file, const Workload& workload) {
  const Columns columns(file);
  if (columns.rows() != workload.queries.size()) refuseCount(file, workload.queries.size(), columns.rows());
  std::vector<Answer> answers(columns.rows());
  const auto column = [&](const char* name, size_t width) -> const Column& {
    const Column* found = columns.find(name);
    if (found && found->width() == width) return *found;
    throw InputError(file, "", "expected records of cyber-radar query, with a column " + std::string(name));
  };
  for (uint64_t i = 0; i < answers.size(); ++i) {
    const std::string place = "record " + std::to_string(i);
    const uint64_t code = column("status", 1).whole(i);
    if (code > static_cast<uint64_t>(Status::invalid)) {
      throw InputError(file, place + ": status", "expected a number from 0 to 4, got " + std::to_string(code));
    }
    const RowReader row{place, workload.queries[i], [&](const std::string& name, size_t part) {
                          if (name == "gap" && !columns.find("gap")) return double{NAN};  // a file of older answers
                          const Column& found = column(name.c_str(), name == "point" || name == "normal" ? 3 : 1);
                          if (found.kind == 'f') return found.real(i, part);
                          const uint64_t whole = found.whole(i);
                          return whole == ~uint64_t{0} ? double{NAN} : static_cast<double>(whole);
                        }};
    answers[i].result = resultOf(row, static_cast<Status>(code), workload, file);
    const bool isSampled = column("tier", 1).whole(i) <= static_cast<uint64_t>(Tier::sampled);
    if (isSampled) answers[i].mode = AnswerMode::sampled;
  }
  return answers;
}

}  // namespace

std::vector<Answer> readAnswers(const std::filesystem::path& file, const Workload& workload) {
  if (answerFormatOf(file) == AnswerFormat::records) return readRecords(file, workload);
  const MappedFile mapped(file, "an answer file");
  return readLines(file, mapped.bytes(), workload);
}

}  // namespace radar::tools
