#include "workloads/query_fields.h"

#include <array>

namespace radar::tools {

namespace {

const QuerySpec kUsual;
constexpr double kAboveZero = std::numeric_limits<double>::denorm_min();

constexpr QueryField kFields[] = {
    {.name = "decide",
     .member = &Query::anyHit,
     .about = "Asks only whether there is a contact; cheaper if there is one",
     .python = "any_hit"},
    {.name = "exclude", .member = &Query::exclude, .about = "Objects that take no part, such as the sensor's own"},
    {.name = "mask",
     .member = &Query::mask,
     .about = "32 bits; an object takes part if its mask shares one",
     .most = ~0u},
    {.name = "speed",
     .member = &QuerySpec::speed,
     .about = "Units per second; the answer then says when",
     .least = kAboveZero,
     .option = true},
    {.name = "ignore_leaving",
     .member = &Query::ignoreLeaving,
     .about = "Counts only what blocks: the sensor may leave what it rests on, or slide along it",
     .python = "ignore_leaving",
     .sampled = false,
     .option = true},
    {.name = "skip_overlapping",
     .member = &Query::skipOverlapping,
     .about = "Leaves out, and lists, objects whose surfaces cross the sensor's at the start",
     .python = "skip_overlapping",
     .sampled = false,
     .option = true},
    {.name = "slack",
     .member = &Query::slack,
     .about = "With these two: how far surfaces that touch may sink into each other, for rounding; else derived from "
              "the coordinates",
     .python = "slack",
     .option = true},
    {.name = "hits",
     .member = &Query::hits,
     .about = "Lists the first contacts with this many nearest objects, one each",
     .least = 1,
     .most = kAllHits - 1,
     .word = "all",
     .python = "hits",
     .sampled = false},
    {.name = "clearance",
     .member = &Query::clearance,
     .about = "Counts as contact when the surfaces come within this distance of each other",
     .python = "clearance",
     .sampled = false,
     .option = true},
    {.name = "tolerance",
     .member = &Query::tolerance,
     .about = "With a clearance: how narrow the bracket of the distance is to be; else 1e-6 of the sensor's size",
     .python = "tolerance"},
};

std::string defaultOf(const QueryField& field) {
  std::string text = "none";
  withMember(field, kUsual, [&]<class Value>(const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) text = value ? "true" : "false";
    if constexpr (std::is_same_v<Value, double>) text = "0";
    if constexpr (std::is_same_v<Value, uint32_t>) text = value == ~0u ? "all" : std::to_string(value);
  });
  return text;
}

}  // namespace

std::span<const QueryField> queryFields() {
  return kFields;
}

bool isGiven(const QueryField& field, const QuerySpec& query) {
  return std::visit([&](auto member) { return query.*member != kUsual.*member; }, field.member);
}

bool takes(const QueryField& field, double value) {
  return value >= field.least && value <= field.most;
}

std::string expectedFor(const QueryField& field) {
  std::string text = field.least > 0 ? "a finite number above 0" : "a finite number of 0 or more";
  withMember(field, kUsual, [&]<class Value>(const Value&) {
    if constexpr (std::is_same_v<Value, bool>) text = "true or false";
    if constexpr (std::is_same_v<Value, std::vector<ObjectId>>) text = "ids of objects";
    if constexpr (std::is_same_v<Value, uint32_t>) {
      text = "a whole number from " + std::to_string(static_cast<uint32_t>(field.least)) + " to " +
             std::to_string(static_cast<uint32_t>(field.most));
    }
  });
  return text + (field.word ? ", or \"" + std::string(field.word) + "\"" : "");
}

const QueryField* exactOnly(const QuerySpec& query) {
  for (const QueryField& field : kFields) {
    if (!field.sampled && isGiven(field, query)) return &field;
  }
  return nullptr;
}

std::string queryFieldTable() {
  std::string text = "| option | value | default | in mode `sampled` | |\n|---|---|---|---|---|\n";
  for (const QueryField& field : kFields) {
    text += "| `" + std::string(field.name) + "` | " + expectedFor(field) + " | " + defaultOf(field) + " | " +
            (field.sampled ? "yes" : "no") + " | " + field.about + " |\n";
  }
  return text;
}

}  // namespace radar::tools
