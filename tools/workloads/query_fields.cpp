#include "workloads/query_fields.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "radar/displacement.h"

namespace radar::tools {

namespace {

const QuerySpec kUsual;
constexpr double kAboveZero = std::numeric_limits<double>::denorm_min(),
                 kInfinity = std::numeric_limits<double>::infinity(), kNone = std::numeric_limits<double>::quiet_NaN();

using Sampled = QueryField::Sampled;
constexpr const char* kSampledWords[] = {"yes", "changes nothing", "no"};

constexpr QueryField kFields[] = {
    {.name = "any_hit",
     .member = &Query::anyHit,
     .about = "Asks only whether there is a contact; cheaper if there is one",
     .cast = true,
     .chain = true},
    {.name = "exclude",
     .member = &Query::exclude,
     .about = "Objects that take no part, such as the sensor's own",
     .chain = true},
    {.name = "mask",
     .member = &Query::mask,
     .about = "32 bits; an object takes part if its mask shares one",
     .most = ~0u,
     .chain = true},
    {.name = "speed",
     .member = &QuerySpec::speed,
     .about = "Units per second; the answer then says when",
     .least = kAboveZero,
     .option = true},
    {.name = "ignore_leaving",
     .member = &Query::ignoreLeaving,
     .about = "Counts only what blocks: the sensor may leave what it rests on, or slide along it",
     .cast = true,
     .sampled = Sampled::no,
     .option = true},
    {.name = "skip_overlapping",
     .member = &Query::skipOverlapping,
     .about = "Leaves out, and lists, objects whose surfaces cross the sensor's at the start",
     .lists = true,
     .cast = true,
     .sampled = Sampled::no,
     .option = true},
    {.name = "slack",
     .member = &Query::slack,
     .about = "With ignore_leaving or skip_overlapping: how far rounding may have sunk surfaces that touch into each "
              "other; else derived from the coordinates",
     .cast = true,
     .sampled = Sampled::idle,
     .option = true},
    {.name = "hits",
     .member = &Query::hits,
     .about = "Lists the first contacts with this many nearest objects, one each",
     .least = 1,
     .most = kAllHits - 1,
     .word = "all",
     .lists = true,
     .cast = true,
     .sampled = Sampled::no,
     .option = true},
    {.name = "closest",
     .member = &Query::closest,
     .about = "Also finds how near the sensor comes to objects on the whole of its way, beyond a contact, too",
     .lists = true,
     .cast = true,
     .sampled = Sampled::no,
     .option = true},
    {.name = "exit",
     .member = &Query::exit,
     .about = "Also finds when the last contact on the way ends: how far it is out of what overlaps",
     .lists = true,
     .cast = true,
     .sampled = Sampled::no,
     .option = true},
    {.name = "clearance",
     .member = &Query::clearance,
     .about = "Counts as contact when the surfaces come within this distance of each other",
     .cast = true,
     .sampled = Sampled::no,
     .option = true,
     .chain = true},
    {.name = "tolerance",
     .member = &Query::tolerance,
     .about =
         "With a clearance, a turn or a chain: how narrow the bracket is to be, as a length; else 1e-6 of the sensor's "
         "size, or of the clearance if that is more",
     .cast = true,
     .sampled = Sampled::idle,
     .option = true,
     .chain = true},
};

std::string defaultOf(const QueryField& field) {
  const double value = field.kind() == 'o' ? kNone : valueIn(kUsual, field);
  if (std::isnan(value)) return "none";
  if (field.kind() == 'b') return value == 0 ? "false" : "true";
  return value == ~0u ? "all" : std::to_string(static_cast<uint32_t>(value));
}

}  // namespace

std::span<const QueryField> queryFields() {
  return kFields;
}

bool isGiven(const QuerySpec& query, const QueryField& field) {
  return std::visit([&](auto member) { return query.*member != kUsual.*member; }, field.member);
}

double valueIn(const QuerySpec& query, const QueryField& field) {
  return std::visit(
      [&]<class Value>(Value QuerySpec::*member) -> double {
        if constexpr (std::is_same_v<Value, std::vector<ObjectId>>) {
          return kNone;
        } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
          return (query.*member).value_or(kNone);
        } else {
          return field.word && query.*member > field.most ? kInfinity : query.*member;
        }
      },
      field.member);
}

bool setValue(QuerySpec& query, const QueryField& field, double value) {
  return std::visit(
      [&]<class Value>(Value QuerySpec::*member) {
        if constexpr (std::is_same_v<Value, std::vector<ObjectId>>) {
          return false;
        } else if constexpr (std::is_same_v<Value, bool>) {
          query.*member = value != 0;
        } else if (std::is_same_v<Value, std::optional<double>> && std::isnan(value)) {
          query.*member = Value();
        } else if (field.word && value == kInfinity) {
          query.*member = static_cast<Value>(field.most + 1);
        } else {
          const bool isWhole = value == std::floor(value);
          if (!(value >= field.least && value <= field.most) || (field.kind() == 'u' && !isWhole)) return false;
          query.*member = static_cast<Value>(value);
        }
        return true;
      },
      field.member);
}

std::string expectedFor(const QueryField& field) {
  if (field.kind() == 'b') return "true or false";
  if (field.kind() == 'o') return "ids of objects";
  if (field.kind() == 'f') return field.least > 0 ? "a finite number above 0" : "a finite number of 0 or more";
  const auto whole = [](double value) { return std::to_string(static_cast<uint32_t>(value)); };
  return "a whole number from " + whole(field.least) + " to " + whole(field.most) +
         (field.word ? ", or \"" + std::string(field.word) + "\"" : "");
}

const QueryField* exactOnly(const QuerySpec& query) {
  for (const QueryField& field : kFields) {
    if (field.sampled == Sampled::no && isGiven(query, field)) return &field;
  }
  return nullptr;
}

QuerySpec sampledPartOf(QuerySpec query) {
  for (const QueryField& field : kFields) {
    if (field.sampled == Sampled::no) std::visit([&](auto member) { query.*member = kUsual.*member; }, field.member);
  }
  query.turn.reset();
  if (query.motion) setDisplacement(query, *query.motion, Mode::sampled, false);
  return query;
}

bool hasLists(const QuerySpec& query) {
  return std::ranges::any_of(kFields, [&](const QueryField& field) { return field.lists && isGiven(query, field); });
}

std::string inOptions(std::string_view message) {
  std::string text;
  for (const char c : message) {
    const bool begins = c >= 'A' && c <= 'Z' && !text.empty() && text.back() >= 'a' && text.back() <= 'z';
    text += begins ? std::string{'_', static_cast<char>(c - 'A' + 'a')} : std::string{c};
  }
  return text;
}

std::string problemOf(const Error& error) {
  const std::string_view what = error.what();
  return inOptions(what.substr(what.find(": ") + 2));
}

std::string queryFieldTable() {
  std::string text = "| option | value | default | in mode `sampled` | |\n|---|---|---|---|---|\n";
  for (const QueryField& field : kFields) {
    text += "| `" + std::string(field.name) + "` | " + expectedFor(field) + " | " + defaultOf(field) + " | " +
            kSampledWords[static_cast<size_t>(field.sampled)] + " | " + field.about + " |\n";
  }
  return text;
}

}  // namespace radar::tools
