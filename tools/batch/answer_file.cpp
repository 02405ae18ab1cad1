#include "batch/answer_file.h"

#include <nlohmann/json.hpp>

#include "batch/atomic_file.h"

namespace radar::tools {

namespace {

void appendKey(std::string& line, const char* key) {
  line += line.empty() ? "{\"" : ", \"";
  line += key;
  line += "\": ";
}

void append(std::string& line, const char* key, double value) {
  appendKey(line, key);
  appendNumber(line, value);
}

void append(std::string& line, const char* key, const std::string& value) {
  appendKey(line, key);
  line += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append(std::string& line, const char* key, uint32_t id) {
  appendKey(line, key);
  line += id == kNone ? "null" : std::to_string(id);
}

void append(std::string& line, const char* key, const std::array<double, 3>& vector) {
  appendKey(line, key);
  if (!(vector[0] == vector[0])) {
    line += "null";
    return;
  }
  line += "[";
  for (int k = 0; k < 3; ++k) {
    if (k > 0) line += ", ";
    appendNumber(line, vector[k]);
  }
  line += "]";
}

const char* wordFor(Detected detected) {
  switch (detected) {
    case Detected::no:
      return "false";
    case Detected::yes:
      return "true";
    case Detected::notLooked:
      break;
  }
  return "null";
}

}  // namespace

const char* nameOf(Status status) {
  constexpr std::array<const char*, 5> kNames{"hit", "clear", "overlap", "undecided", "invalid"};
  return kNames[static_cast<size_t>(status)];
}

const char* nameOf(Tier tier) {
  constexpr std::array<const char*, 4> kNames{"select", "sampled", "contact", "reference"};
  return kNames[static_cast<size_t>(tier)];
}

std::string answerLine(const QuerySpec& query, const Result& result, AnswerMode mode, const std::string& reason) {
  std::string line;
  append(line, "id", query.id);
  append(line, "status", std::string(nameOf(result.status)));
  if (result.status == Status::invalid) append(line, "reason", reason);
  append(line, "t", result.t);
  append(line, "lo", result.lo);
  append(line, "hi", result.hi);
  append(line, "fraction", result.fraction);
  if (query.speed) append(line, "time", result.t / *query.speed);
  appendKey(line, "detected");
  line += wordFor(result.detected);
  append(line, "object", result.object);
  append(line, "tri_a", result.triA);
  append(line, "tri_b", result.triB);
  append(line, "point", result.point);
  append(line, "normal", result.normal);
  append(line, "tier", std::string(nameOf(result.tier)));
  if (mode == AnswerMode::sampled) append(line, "paper_min_l", result.paperMinL);
  line += "}";
  return line;
}

}  // namespace radar::tools
