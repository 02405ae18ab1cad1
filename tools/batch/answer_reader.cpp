#include "batch/answer_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "batch/answer_rows.h"
#include "batch/mapped_file.h"

namespace radar::tools {

namespace {

/// One row of a file.
struct RowReader {
  const std::string& file;
  std::string place;  ///< for messages
  const QuerySpec& query;
  /// NaN for null; of a code, its number.
  std::function<double(const AnswerField& field, size_t part)> number;

  [[noreturn]] void refuse(const char* name, const std::string& problem) const {
    throw InputError(file, place + ": " + name, problem);
  }
};

void requireBelow(const RowReader& row, const char* name, uint64_t limit) {
  const double value = row.number(*findAnswerField(name), 0);
  if (std::isnan(value) || (value >= 0 && value < static_cast<double>(limit))) return;
  row.refuse(name, "expected a whole number below " + std::to_string(limit) + ", got " + inShortest(value));
}

/// A mesh of one of a chain's links, or none.
const MeshData* meshOf(const RowReader& row, const Workload& workload, const char* linkName, const char* meshName,
                       uint32_t& link, uint32_t& mesh) {
  const ChainSpec& chain = workload.chains[row.query.chain->chain];
  const double number = row.number(*findAnswerField(linkName), 0);
  if (std::isnan(number)) return nullptr;
  requireBelow(row, linkName, chain.links.size());
  link = static_cast<uint32_t>(number);
  const std::vector<LinkMesh>& meshes = chain.links[link].meshes;
  requireBelow(row, meshName, meshes.size());
  const double place = row.number(*findAnswerField(meshName), 0);
  if (std::isnan(place)) row.refuse(meshName, "expected the number of a mesh, got none");
  mesh = static_cast<uint32_t>(place);
  return &workload.meshes[meshes[mesh].mesh];
}

/// `status`: of a contact in a list, which has none of its own. `links`: read of a chain's answer.
Result resultOf(const RowReader& row, const Workload& workload, std::optional<Status> status, LinksMet& links) {
  const QuerySpec& query = row.query;
  const AnswerField& ofStatus = *findAnswerField("status");
  const double code = status ? double(*status) : row.number(ofStatus, 0);
  if (std::isnan(code)) row.refuse("status", "expected a status, got none");
  Result result(static_cast<Status>(static_cast<uint32_t>(code)));
  requireBelow(row, "object", workload.objectCount(query.scene));
  const MeshData *moved = query.chain ? nullptr : &workload.meshes[query.mesh], *touched = nullptr;
  if (query.chain) {
    moved = meshOf(row, workload, "link", "mesh", links.link, links.mesh);
    touched = meshOf(row, workload, "other_link", "other_mesh", links.otherLink, links.otherMesh);
  }
  if (moved != nullptr) requireBelow(row, "tri_a", moved->triangleCount());
  for (const AnswerField& field : answerFields()) {
    if (!field.set || &field == &ofStatus || field.line == When::never) continue;
    const AnswerField& from = takesStep(query) && field.ofStep ? *findAnswerField(field.ofStep) : field;
    for (size_t part = 0; part < field.width; ++part) field.set(result, row.number(from, part), part);
  }
  if (result.object != kNone) touched = &workload.meshes[workload.instance(query.scene, result.object).mesh];
  if (moved == nullptr) result.triA = kNone;
  if (touched == nullptr) {
    result.triB = kNone;
  } else {
    requireBelow(row, "tri_b", touched->triangleCount());
  }
  const bool touches = touched != nullptr && (result.status == Status::hit || result.status == Status::overlap);
  if (!(query.clearance > 0)) result.gap = touches ? 0 : double{NAN};
  return result;
}

RowReader membersOf(const JsonValue& from, const std::string& file, const std::string& place, const QuerySpec& query) {
  return {file, place, query, [from](const AnswerField& field, size_t part) { return memberIn(from, field, part); }};
}

/// A contact in a list.
Result contactOf(const RowReader& row, const Workload& workload) {
  const double hi = row.number(*findAnswerField("hi"), 0);
  LinksMet links;
  return resultOf(row, workload, std::isnan(hi) ? Status::undecided : hi == 0 ? Status::overlap : Status::hit, links);
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
    Answer& answer = answers.emplace_back();
    answer.result = resultOf(membersOf(root, file, place, query), workload, {}, answer.links);
    root.ifHas("hits", [&](const JsonValue& list) {
      list.forEach([&](const JsonValue& hit) {
        hit.member("object").index(workload.objectCount(query.scene), "objects");
        const std::string at = place + ": hits[" + std::to_string(answer.listed.hits.size()) + "]";
        answer.listed.hits.push_back(contactOf(membersOf(hit, file, at, query), workload));
      });
    });
    const auto momentOf = [&](const char* name, const auto& use) {
      root.ifHas(name, [&](const JsonValue& moment) {
        if (!moment.json().is_null()) use(moment, membersOf(moment, file, place + ": " + name, query));
      });
    };
    momentOf("closest", [&](const JsonValue& closest, const RowReader& row) {
      LinksMet none;
      answer.listed.closest = Closest{closest.member("distance_lo").number(), closest.member("distance_hi").number(),
                                      resultOf(row, workload, Status::hit, none)};
      answer.listed.closest->at.gap = answer.listed.closest->hi;
    });
    momentOf("exit", [&](const JsonValue&, const RowReader& row) {
      const bool isOpen = std::isnan(row.number(*findAnswerField("t"), 0));
      LinksMet none;
      answer.listed.exit = resultOf(row, workload, isOpen ? Status::undecided : Status::hit, none);
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
  for (uint64_t i = 0; i < answers.size(); ++i) {
    const RowReader row{file, "record " + std::to_string(i), workload.queries[i],
                        [&](const AnswerField& field, size_t part) { return memberIn(columns, i, field, part); }};
    answers[i].result = resultOf(row, workload, {}, answers[i].links);
    if (answers[i].result.tier <= Tier::sampled) answers[i].mode = AnswerMode::sampled;
  }
  return answers;
}

}  // namespace

double memberIn(const JsonValue& object, const AnswerField& field, size_t part) {
  if (!object.has(field.name) || object.member(field.name).json().is_null()) return NAN;
  const JsonValue value = object.member(field.name);
  if (field.isTruth()) return value.boolean();
  if (!field.words.empty()) {
    const double code = codeOf(field, value.string());
    if (std::isnan(code)) value.expected(wordsOf(field));
    return code;
  }
  if (field.width == 1) return value.number();
  if (value.size() != field.width) value.expected("three numbers");
  return value[part].json().is_null() ? NAN : value[part].number();  // too large for a double
}

double memberIn(const Columns& records, uint64_t row, const AnswerField& field, size_t part) {
  const Column* const column = records.find(field.name);
  if (!column && field.line == When::chain) return NAN;  // records have none
  if (!column || column->width() != field.width) {
    throw InputError(records.name(), "",
                     "expected records of cyber-radar query, with a column " + std::string(field.name));
  }
  if (field.isReal() != (column->kind == 'f')) {
    throw InputError(records.name(), field.name,
                     std::string("expected ") + (field.isReal() ? "floats" : "integers") + ", got " + column->type());
  }
  if (field.isReal()) return column->real(row, part);
  const uint64_t whole = column->whole(row);
  if (whole == ~uint64_t{0}) return NAN;
  if (!field.words.empty() && whole >= field.words.size()) {
    throw InputError(
        records.name(), "record " + std::to_string(row) + ": " + field.name,
        "expected a number from 0 to " + std::to_string(field.words.size() - 1) + ", got " + std::to_string(whole));
  }
  return static_cast<double>(whole);
}

std::vector<Answer> readAnswers(const std::filesystem::path& file, const Workload& workload) {
  if (readFormatOf(file) == AnswerFormat::records) return readRecords(file, workload);
  const MappedFile mapped(file, "an answer file");
  return readLines(file, mapped.bytes(), workload);
}

}  // namespace radar::tools
