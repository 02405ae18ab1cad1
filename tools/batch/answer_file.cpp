#include "batch/answer_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "batch/json_output.h"

namespace radar::tools {

namespace {

constexpr double kNull = std::numeric_limits<double>::quiet_NaN();

/// Distances of the sensor in world units, and fractions. With a motion, the times of a result are fractions.
struct Times {
  Times(const QuerySpec& query, const Result& result) {
    constexpr double kRoom = 0x1p-50;
    const double length = query.motion ? std::hypot((*query.motion)[0], (*query.motion)[1], (*query.motion)[2]) : 1,
                 room = query.motion ? kRoom : 0;
    t = length * result.t;
    lo = (1 - room) * length * result.lo;
    hi = (1 + room) * length * result.hi;
    fraction = result.fraction;
    fractionLo = query.motion ? result.lo : kNull;
    fractionHi = query.motion ? result.hi : kNull;
    time = query.speed ? length * result.t / *query.speed : kNull;
  }
  double t, lo, hi, fraction, fractionLo, fractionHi, time;
};

struct Row {
  uint64_t index;  ///< of the query
  const QuerySpec& query;
  const Result& result;
  bool isSampled;  ///< answered in mode sampled
  Times times{query, result};
};

/// The lines that have a member: stepsAndHits those of steps, nearAndHits those with a clearance, timed with a speed,
/// sampled in that mode; hits are those that a line lists.
enum class In { none, lines, linesAndHits, stepsAndHits, nearAndHits, timed, sampled };

constexpr size_t kNowhere = ~size_t{0};

struct AnswerField {
  const char* name;
  const char* type;  ///< in a record, as numpy writes it
  size_t place;      ///< in a record, or kNowhere
  /// NaN is null; in a record so is an infinity, and in whole numbers null is -1.
  double (*value)(const Row& row, size_t part);
  In in = In::lines;
  std::string (*text)(double value) = nullptr;  ///< in a line, of a number that is a code
  size_t width = 1;                             ///< numbers
};

double numberOf(uint32_t id, size_t) {
  return id == kNone ? kNull : id;
}

double numberOf(const std::array<double, 3>& vector, size_t part) {
  return std::isnan(vector[0]) ? kNull : vector[part];
}

template <class Code>
double numberOf(Code code, size_t) {
  return static_cast<double>(code);
}

double numberOf(Detected detected, size_t) {
  return detected == Detected::notLooked ? kNull : double(detected == Detected::yes);
}

/// The value of a member of Times or Result.
template <auto member>
double valueOf(const Row& row, size_t part) {
  if constexpr (std::is_same_v<decltype(member), double Times::*>) {
    return row.times.*member;
  } else {
    return numberOf(row.result.*member, part);
  }
}

/// The sensor's point that is nearest to the touched surface.
double sensorPoint(const Row& row, size_t part) {
  const Result& result = row.result;
  if (std::isnan(result.gap)) return kNull;
  return std::isnan(result.normal[0]) ? result.point[part] : result.point[part] + result.gap * result.normal[part];
}

template <class Code>
std::string wordOf(double value) {
  return "\"" + std::string(nameOf(static_cast<Code>(value))) + "\"";
}

std::string featureWord(double value) {
  return value == 0 ? "null" : wordOf<Feature>(value);
}

constexpr AnswerField kObject{"object", "<i8", 120, valueOf<&Result::object>, In::linesAndHits};

// In the order of lines.
constexpr AnswerField kFields[] = {
    {"query", "<u8", 0, [](const Row& row, size_t) { return double(row.index); }, In::none},
    {"status", "|u1", 152, valueOf<&Result::status>, In::lines, wordOf<Status>},
    {"t", "<f8", 8, valueOf<&Times::t>, In::linesAndHits},
    {"lo", "<f8", 16, valueOf<&Times::lo>, In::linesAndHits},
    {"hi", "<f8", 24, valueOf<&Times::hi>, In::linesAndHits},
    {"fraction", "<f8", 32, valueOf<&Times::fraction>},
    {"fraction_lo", "<f8", 40, valueOf<&Times::fractionLo>, In::stepsAndHits},
    {"fraction_hi", "<f8", 48, valueOf<&Times::fractionHi>, In::stepsAndHits},
    {"time", "<f8", 56, valueOf<&Times::time>, In::timed},
    {"detected", "|i1", 156, valueOf<&Result::detected>, In::lines,
     [](double v) { return std::string(v == 0 ? "false" : "true"); }},
    kObject,
    {"tri_a", "<i8", 128, valueOf<&Result::triA>, In::linesAndHits},
    {"tri_b", "<i8", 136, valueOf<&Result::triB>, In::linesAndHits},
    {"feature_a", "|u1", 154, valueOf<&Result::featureA>, In::linesAndHits, featureWord},
    {"feature_b", "|u1", 155, valueOf<&Result::featureB>, In::linesAndHits, featureWord},
    {"point", "<f8", 72, valueOf<&Result::point>, In::linesAndHits, nullptr, 3},
    {"normal", "<f8", 96, valueOf<&Result::normal>, In::linesAndHits, nullptr, 3},
    {"gap", "<f8", 144, valueOf<&Result::gap>, In::nearAndHits},
    {"sensor_point", "<f8", kNowhere, sensorPoint, In::nearAndHits, nullptr, 3},
    {"tier", "|u1", 153, valueOf<&Result::tier>, In::lines, wordOf<Tier>},
    {"paper_min_l", "<f8", 64, [](const Row& row, size_t) { return row.isSampled ? row.result.paperMinL : kNull; },
     In::sampled},
};

bool isIn(In in, const Row& row, bool isHit) {
  return in == In::linesAndHits || (in == In::stepsAndHits && row.query.motion) ||
         (in == In::nearAndHits && row.query.clearance > 0) ||
         (!isHit && (in == In::lines || (in == In::timed && row.query.speed) || (in == In::sampled && row.isSampled)));
}

void append(std::string& text, const AnswerField& field, double value) {
  if (field.type[1] == 'f') {
    appendNumber(text, value);
  } else if (std::isnan(value)) {
    text += "null";
  } else {
    text += field.text ? field.text(value) : std::to_string(static_cast<uint64_t>(value));
  }
}

void add(JsonObject& to, const AnswerField& field, const Row& row, std::span<const std::string> names) {
  std::string& text = to.begin(field.name);
  if (field.width == 1 || std::isnan(field.value(row, 0))) {
    append(text, field, field.value(row, 0));
  } else {
    for (size_t part = 0; part < field.width; ++part) {
      append(text += part == 0 ? "[" : ", ", field, field.value(row, part));
    }
    text += "]";
  }
  if (field.name != kObject.name || names.empty()) return;
  const ObjectId object = row.result.object;
  to.add("object_name", object == kNone || names[object].empty() ? "null" : quoted(names[object]));
}

std::string hitText(const QuerySpec& query, const Result& hit, std::span<const std::string> names) {
  const Row row{0, query, hit, false};
  JsonObject object;
  add(object, kObject, row, names);
  for (const AnswerField& field : kFields) {
    if (field.name != kObject.name && isIn(field.in, row, true)) add(object, field, row, names);
  }
  return object.text();
}

template <class Number>
void put(char* to, double value) {
  if (!std::isfinite(value)) value = std::is_floating_point_v<Number> ? std::numeric_limits<double>::quiet_NaN() : -1;
  const auto number = static_cast<Number>(value);
  std::memcpy(to, &number, sizeof number);
}

}  // namespace

const char* nameOf(Status status) {
  constexpr std::array<const char*, 5> kNames{"hit", "clear", "overlap", "undecided", "invalid"};
  return kNames[static_cast<size_t>(status)];
}

Status statusFrom(std::string_view name) {
  for (uint32_t code = 0; code <= static_cast<uint32_t>(Status::invalid); ++code) {
    if (name == nameOf(static_cast<Status>(code))) return static_cast<Status>(code);
  }
  throw std::invalid_argument("expected hit, clear, overlap, undecided or invalid, got \"" + std::string(name) + "\"");
}

const char* nameOf(Tier tier) {
  constexpr std::array<const char*, 4> kNames{"select", "sampled", "contact", "reference"};
  return kNames[static_cast<size_t>(tier)];
}

const char* nameOf(Feature feature) {
  constexpr std::array<const char*, 4> kNames{"none", "vertex", "edge", "face"};
  return kNames[static_cast<size_t>(feature)];
}

std::string answerLine(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames) {
  const Row row{0, query, answer.result, answer.mode == AnswerMode::sampled};
  JsonObject line;
  line.addString("id", query.id);
  for (const AnswerField& field : kFields) {
    if (!isIn(field.in, row, false)) continue;
    add(line, field, row, objectNames);
    const bool isInvalid = answer.result.status == Status::invalid;
    if (isInvalid && field.name == std::string_view("status")) line.addString("reason", answer.reason);
  }
  if (query.hits > 1) {
    line.add("hits", listOf(answer.listed.hits, ", ",
                            [&](std::string& text, const Result& hit) { text += hitText(query, hit, objectNames); }));
  }
  if (query.skipOverlapping) {
    line.add("overlapping", listOf(answer.listed.overlapping, ", ",
                                   [](std::string& text, ObjectId id) { text += std::to_string(id); }));
    if (!objectNames.empty()) {
      line.add("overlapping_names", listOf(answer.listed.overlapping, ", ", [&](std::string& text, ObjectId id) {
                 text += objectNames[id].empty() ? "null" : quoted(objectNames[id]);
               }));
    }
  }
  return line.text();
}

void appendRecord(std::string& records, uint64_t index, const QuerySpec& query, const Answer& answer) {
  static_assert(std::endian::native == std::endian::little);
  const Row row{index, query, answer.result, answer.mode == AnswerMode::sampled};
  const size_t start = records.size();
  records.resize(start + kRecordLength);
  for (const AnswerField& field : kFields) {
    for (size_t part = 0; part < field.width && field.place != kNowhere; ++part) {
      char* const to = &records[start + field.place + 8 * part];
      const double value = field.value(row, part);
      if (field.type[2] == '1') {
        put<int8_t>(to, value);
      } else if (field.type[1] == 'f') {
        put<double>(to, value);
      } else {
        put<int64_t>(to, value);
      }
    }
  }
}

std::string recordDescription() {
  std::vector<AnswerField> fields(std::begin(kFields), std::end(kFields));
  std::erase_if(fields, [](const AnswerField& field) { return field.place == kNowhere; });
  std::ranges::sort(fields, {}, &AnswerField::place);
  std::string text = "[";
  for (const AnswerField& field : fields) {
    text += "('" + std::string(field.name) + "', '" + field.type + (field.width == 1 ? "'), " : "', (3,)), ");
  }
  return text + "('', '|V3')]";
}

}  // namespace radar::tools
