#include "batch/answer_file.h"

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

std::string hitText(const Result& hit) {
  JsonObject object;
  object.add("object", idText(hit.object));
  object.addNumber("t", hit.t);
  object.addNumber("lo", hit.lo);
  object.addNumber("hi", hit.hi);
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

std::string answerLine(const QuerySpec& query, const Answer& answer) {
  const Result& result = answer.result;
  JsonObject line;
  line.addString("id", query.id);
  line.addString("status", nameOf(result.status));
  if (result.status == Status::invalid) line.addString("reason", answer.reason);
  line.addNumber("t", result.t);
  line.addNumber("lo", result.lo);
  line.addNumber("hi", result.hi);
  line.addNumber("fraction", result.fraction);
  if (query.speed) line.addNumber("time", result.t / *query.speed);
  line.add("detected", wordFor(result.detected));
  line.add("object", idText(result.object));
  line.add("tri_a", idText(result.triA));
  line.add("tri_b", idText(result.triB));
  line.add("feature_a", featureText(result.featureA));
  line.add("feature_b", featureText(result.featureB));
  line.add("point", vectorText(result.point));
  line.add("normal", vectorText(result.normal));
  line.addString("tier", nameOf(result.tier));
  if (answer.mode == AnswerMode::sampled) line.addNumber("paper_min_l", result.paperMinL);
  if (query.hits > 1) {
    line.add("hits", listOf(answer.hits, ", ", [](std::string& text, const Result& hit) { text += hitText(hit); }));
  }
  if (query.skipOverlapping) {
    line.add("overlapping",
             listOf(answer.overlapping, ", ", [](std::string& text, ObjectId id) { text += std::to_string(id); }));
  }
  return line.text();
}

}  // namespace radar::tools
