#include "batch/answer_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "batch/json_output.h"

namespace radar::tools {

namespace {

/// Appends a number, or a code's word; nothing if there is none.
void appendPlain(std::string& text, const AnswerField& field, double value) {
  if (!std::isfinite(value)) return;
  if (field.isReal()) {
    appendNumber(text, value);
  } else if (field.words.empty()) {
    text += std::to_string(static_cast<uint64_t>(value));
  } else if (const std::string_view word = field.words[static_cast<size_t>(value)]; word != "none") {
    text += word;
  }
}

void appendJson(std::string& text, const AnswerField& field, double value) {
  const bool isQuoted = !field.words.empty() && !field.isTruth();
  const size_t start = text.size();
  if (isQuoted) text += '"';
  appendPlain(text, field, value);
  if (text.size() == start + isQuoted) {
    text.replace(start, isQuoted, "null");
  } else if (isQuoted) {
    text += '"';
  }
}

void add(JsonObject& to, const AnswerField& field, const AnswerRow& row, const AnswerNames& names) {
  std::string& text = to.begin(field.name);
  if (field.width == 1 || std::isnan(field.value(row, 0))) {
    appendJson(text, field, field.value(row, 0));
  } else {
    for (size_t part = 0; part < field.width; ++part) {
      appendJson(text += part == 0 ? "[" : ", ", field, field.value(row, part));
    }
    text += "]";
  }
  const auto addName = [&](const char* member, uint32_t id, std::span<const std::string> of) {
    if (of.empty() || field.name + std::string("_name") != member) return;
    to.add(member, id == kNone || of[id].empty() ? "null" : quoted(of[id]));
  };
  addName("object_name", row.result.object, names.objects);
  addName("link_name", row.links.value_or(LinksMet{}).link, names.links);
  addName("other_link_name", row.links.value_or(LinksMet{}).otherLink, names.links);
}

AnswerRow rowOf(const QuerySpec& query, const Answer& answer, uint64_t index = 0) {
  return {query,       answer.result, answer.mode,
          query.speed, index,         query.chain ? std::optional(answer.links) : std::nullopt};
}

/// Adds the members of a contact in a list, without those that are named.
void addHit(JsonObject& object, const QuerySpec& query, const Result& hit, const AnswerNames& names,
            std::initializer_list<std::string_view> without = {}) {
  const AnswerRow row(query, hit, AnswerMode::contact);
  const AnswerField* const first = findAnswerField("object");
  add(object, *first, row, names);
  for (const AnswerField& field : answerFields()) {
    if (&field == first || !has(row, field.hit) || std::ranges::find(without, field.name) != without.end()) continue;
    add(object, field, row, names);
  }
}

std::string hitText(const QuerySpec& query, const Result& hit, const AnswerNames& names) {
  JsonObject object;
  addHit(object, query, hit, names);
  return object.text();
}

std::string closestText(const QuerySpec& query, const Closest& closest, const AnswerNames& names) {
  if (closest.at.object == kNone) return "null";
  JsonObject object;
  object.addNumber("distance_lo", closest.lo);
  object.addNumber("distance_hi", closest.hi);
  // Where it is has no bracket, and its gap lies between these two.
  addHit(object, query, closest.at, names, {"lo", "hi", "fraction_lo", "fraction_hi", "gap", "sensor_point"});
  const AnswerRow row(query, closest.at, AnswerMode::contact);
  add(object, *findAnswerField("sensor_point"), row, names);
  return object.text();
}

bool isInTable(const AnswerField& field) {
  return field.line != When::never;
}

}  // namespace

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quotes = "\"";
  for (const char c : text) quotes.append(c == '"' ? 2 : 1, c);
  return quotes + "\"";
}

std::string tableHead() {
  std::string head = "id";
  for (const AnswerField& field : answerFields()) {
    if (!isInTable(field)) continue;
    if (field.width == 1) head.append(",").append(field.name);
    for (size_t part = 0; part < field.width && field.width > 1; ++part) {
      head.append(",").append(field.name).append("_") += "xyz"[part];
    }
  }
  return head + ",object_name,reason\n";
}

std::string tableRow(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames) {
  const AnswerRow row = rowOf(query, answer);
  std::string text = cell(query.id);
  for (const AnswerField& field : answerFields()) {
    for (size_t part = 0; part < field.width && isInTable(field); ++part) {
      text += ',';
      if (has(row, field.line)) appendPlain(text, field, field.value(row, part));
    }
  }
  const ObjectId object = answer.result.object;
  text += "," + (object == kNone || objectNames.empty() ? "" : cell(objectNames[object]));
  return text + "," + cell(answer.reason) + "\n";
}

std::string answerLine(const QuerySpec& query, const Answer& answer, const AnswerNames& names) {
  const AnswerRow row = rowOf(query, answer);
  JsonObject line;
  line.addString("id", query.id);
  for (const AnswerField& field : answerFields()) {
    if (!has(row, field.line)) continue;
    add(line, field, row, names);
    const bool isInvalid = answer.result.status == Status::invalid;
    if (isInvalid && field.name == std::string_view("status")) line.addString("reason", answer.reason);
  }
  if (query.hits > 1) {
    line.add("hits", listOf(answer.listed.hits, ", ",
                            [&](std::string& text, const Result& hit) { text += hitText(query, hit, names); }));
  }
  if (query.skipOverlapping) {
    line.add("overlapping", listOf(answer.listed.overlapping, ", ",
                                   [](std::string& text, ObjectId id) { text += std::to_string(id); }));
    if (const std::vector<std::string>& objectNames = names.objects; !objectNames.empty()) {
      line.add("overlapping_names", listOf(answer.listed.overlapping, ", ", [&](std::string& text, ObjectId id) {
                 text += objectNames[id].empty() ? "null" : quoted(objectNames[id]);
               }));
    }
  }
  const Listed& listed = answer.listed;
  if (query.closest) line.add("closest", listed.closest ? closestText(query, *listed.closest, names) : "null");
  if (query.exit) {
    const bool isTouched = listed.exit && listed.exit->status != Status::clear;
    line.add("exit", isTouched ? hitText(query, *listed.exit, names) : "null");
  }
  return line.text();
}

void appendRecord(std::string& records, uint64_t index, const QuerySpec& query, const Answer& answer) {
  const size_t start = records.size();
  records.resize(start + fileLayout().size);
  fileLayout().write(rowOf(query, answer, index), &records[start]);
}

std::string recordDescription() {
  std::string text = "[";
  for (const auto& [field, place] : fileLayout().members) {
    text += "('" + std::string(field->name) + "', '" + field->type + (field->width == 1 ? "'), " : "', (3,)), ");
  }
  return text + "('', '|V3')]";
}

}  // namespace radar::tools
