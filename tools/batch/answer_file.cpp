#include "batch/answer_file.h"

#include <cmath>
#include <limits>

#include "batch/json_output.h"

namespace radar::tools {

namespace {

std::string idText(uint32_t id) {
  return id == kNone ? "null" : std::to_string(id);
}

std::string vectorText(const std::array<double, 3>& vector) {
  return std::isnan(vector[0]) ? "null" : listOf(vector, ", ", appendNumber);
}

std::string featureText(Feature feature) {
  return feature == Feature::none ? "null" : "\"" + std::string(nameOf(feature)) + "\"";
}

const char* wordFor(Detected detected) {
  return detected == Detected::no ? "false" : detected == Detected::yes ? "true" : "null";
}

void addObject(JsonObject& to, ObjectId object, std::span<const std::string> names) {
  to.add("object", idText(object));
  if (names.empty()) return;
  to.add("object_name", object == kNone || names[object].empty() ? "null" : quoted(names[object]));
}

// Adds t, lo and hi; `hasFraction`: the fractions, too.
void addTimes(JsonObject& object, const QuerySpec& query, const Result& result, bool hasFraction) {
  const AnswerTimes times = timesOf(query, result);
  object.addNumber("t", times.t);
  object.addNumber("lo", times.lo);
  object.addNumber("hi", times.hi);
  if (hasFraction) object.addNumber("fraction", times.fraction);
  if (query.motion) {
    object.addNumber("fraction_lo", times.fractionLo);
    object.addNumber("fraction_hi", times.fractionHi);
  }
  if (hasFraction && query.speed) object.addNumber("time", times.time);
}

std::string hitText(const QuerySpec& query, const Result& hit, std::span<const std::string> objectNames) {
  JsonObject object;
  addObject(object, hit.object, objectNames);
  addTimes(object, query, hit, false);
  object.add("tri_a", idText(hit.triA));
  object.add("tri_b", idText(hit.triB));
  object.add("feature_a", featureText(hit.featureA));
  object.add("feature_b", featureText(hit.featureB));
  object.add("point", vectorText(hit.point));
  object.add("normal", vectorText(hit.normal));
  return object.text();
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

const char* nameOf(Feature feature) {
  constexpr std::array<const char*, 4> kNames{"none", "vertex", "edge", "face"};
  return kNames[static_cast<size_t>(feature)];
}

// With a motion, the times of a result are fractions.
AnswerTimes timesOf(const QuerySpec& query, const Result& result) {
  constexpr double kRoom = 0x1p-50, kNone = std::numeric_limits<double>::quiet_NaN();
  const double length = query.motion ? std::hypot((*query.motion)[0], (*query.motion)[1], (*query.motion)[2]) : 1,
               room = query.motion ? kRoom : 0;
  AnswerTimes times;
  times.t = length * result.t;
  times.lo = (1 - room) * length * result.lo;
  times.hi = (1 + room) * length * result.hi;
  times.fraction = result.fraction;
  times.fractionLo = query.motion ? result.lo : kNone;
  times.fractionHi = query.motion ? result.hi : kNone;
  times.time = query.speed ? length * result.t / *query.speed : kNone;
  return times;
}

std::string answerLine(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames) {
  const Result& result = answer.result;
  JsonObject line;
  line.addString("id", query.id);
  line.addString("status", nameOf(result.status));
  if (result.status == Status::invalid) line.addString("reason", answer.reason);
  addTimes(line, query, result, true);
  line.add("detected", wordFor(result.detected));
  addObject(line, result.object, objectNames);
  line.add("tri_a", idText(result.triA));
  line.add("tri_b", idText(result.triB));
  line.add("feature_a", featureText(result.featureA));
  line.add("feature_b", featureText(result.featureB));
  line.add("point", vectorText(result.point));
  line.add("normal", vectorText(result.normal));
  line.addString("tier", nameOf(result.tier));
  if (answer.mode == AnswerMode::sampled) line.addNumber("paper_min_l", result.paperMinL);
  if (query.hits > 1) {
    line.add("hits", listOf(answer.listed.hits, ", ",
                            [&](std::string& text, const Result& hit) { text += hitText(query, hit, objectNames); }));
  }
  if (query.skipOverlapping) {
    line.add("overlapping", listOf(answer.listed.overlapping, ", ",
                                   [](std::string& text, ObjectId id) { text += std::to_string(id); }));
  }
  return line.text();
}

}  // namespace radar::tools
