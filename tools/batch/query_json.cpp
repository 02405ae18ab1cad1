#include "batch/query_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "batch/chain_json.h"
#include "batch/query_file.h"
#include "import/float_vertices.h"
#include "radar/displacement.h"
#include "workloads/query_fields.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

bool isCutter(const Workload& workload, const QuerySpec& query) {
  return !query.chain && !workload.meshes[query.mesh].cutter.parts.empty();
}

constexpr std::string_view kLater[] = {"rotation"};

void readField(const JsonValue& value, const QueryField& field, QuerySpec& to) {
  const nlohmann::json& json = value.json();
  double number = HUGE_VAL;
  bool fits = true;
  if (field.kind() == 'b') {
    number = value.boolean();
  } else if (!field.word || json != field.word) {
    fits = field.kind() == 'u' ? json.is_number_unsigned() : json.is_number();
    number = fits ? json.get<double>() : 0;
  }
  if (!fits || !setValue(to, field, number)) value.expected(expectedFor(field));
}

void readFields(const JsonValue& query, uint32_t objects, QuerySpec& to) {
  for (const QueryField& field : queryFields()) {
    query.ifHas(field.name, [&](const JsonValue& value) {
      if (field.kind() != 'o') return readField(value, field, to);
      value.forEach(
          [&](const JsonValue& id) { to.exclude.push_back(id.index(objects, "objects of the query's scene")); });
    });
  }
  if (to.hits > 1 && to.anyHit) query.member("hits").expected("1 beside \"any_hit\"");
}

}  // namespace

void requireKnownKeys(const JsonValue& object, std::span<const std::string_view> known) {
  object.requireObject();
  for (const auto& [key, value] : object.json().items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (std::string_view name : known) list.append(list.empty() ? "" : ", ").append(name);
    const bool isLater = std::find(std::begin(kLater), std::end(kLater), key) != std::end(kLater);
    object.member(key.c_str())
        .refuse("expected one of the keys " + list + ", got \"" + printable(key, 60) + "\"" +
                (isLater ? ", which is reserved for a later version" : ""));
  }
}

std::array<double, 3> vectorFrom(const JsonValue& list) {
  if (list.size() != 3) list.expected("3 numbers");
  return {list[0].number(), list[1].number(), list[2].number()};
}

Transform poseFrom(const JsonValue& list) {
  if (list.size() != 12) list.expected("12 numbers");
  Transform pose;
  for (size_t i = 0; i < 12; ++i) pose.m[i] = list[i].number();
  if (std::string wrong = validate(pose); !wrong.empty()) list.refuse(wrong);
  return pose;
}

std::array<double, 3> motionFrom(const JsonValue& list, size_t first) {
  std::array<double, 3> motion{};
  for (size_t k = 0; k < 3; ++k) {
    motion[k] = list[first + k].number();
    if (std::abs(motion[k]) > 0x1p1000) list[first + k].expected("a number of at most 2^1000");
  }
  return motion;
}

Turn turnFrom(const JsonValue& value) {
  requireKnownKeys(value, {"axis", "angle", "centre"});
  const JsonValue axis = value.member("axis"), angle = value.member("angle"), centre = value.member("centre");
  const Turn turn{vectorFrom(axis), angle.number(), vectorFrom(centre)};
  if (std::abs(turn.angle) > 0x1p16) angle.expected("a number of at most 2^16");
  if (turn.angle != 0 && turn.axis == std::array<double, 3>{}) axis.expected("a vector that is not zero");
  for (size_t k = 0; k < 3; ++k) {
    if (std::abs(turn.centre[k]) > 0x1p800) centre[k].expected("a number of at most 2^800");
  }
  return turn;
}

/// Of a turn given by the pose at its end: {"to": 12 numbers, "about": a point of the mesh}.
void readTurnTo(const JsonValue& value, const MeshData& mesh, const std::array<double, 3>& base, QuerySpec& query) {
  requireKnownKeys(value, {"to", "about"});
  const JsonValue to = value.member("to");
  const Transform end = poseFrom(to);
  std::array<double, 3> about{};
  if (value.has("about")) {
    about = vectorFrom(value.member("about"));
    for (size_t k = 0; k < 3; ++k) about[k] -= base[k];
  } else {
    const auto box = boundsOf(MeshView{mesh.positions, mesh.indices}, Transform{});
    for (size_t k = 0; k < 3; ++k) about[k] = 0.5 * (box.low[k] + box.high[k]);
  }
  try {
    const TurnAndMotion found = turnBetween(query.worldFromMesh, aboutBase(end, base), about);
    query.turn = found.turn;
    query.motion = found.motion;
  } catch (const Error& error) {
    value.refuse(problemOf(error));
  }
}

Instance instanceFrom(const JsonValue& list, std::span<const std::array<double, 3>> bases) {
  const size_t count = list.size();
  if (count != 1 && count != 13) list.expected("a mesh index, alone or followed by 12 numbers");
  Instance instance;
  instance.mesh = list[0].index(bases.size(), "meshes");
  for (size_t i = 1; i < count; ++i) instance.worldFromMesh.m[i - 1] = list[i].number();
  if (std::string wrong = validate(instance.worldFromMesh); !wrong.empty()) list.refuse(wrong);
  instance.worldFromMesh = aboutBase(instance.worldFromMesh, bases[instance.mesh]);
  return instance;
}

std::string onlySensor(const MeshData& mesh) {
  if (!mesh.cutter.parts.empty()) return "expected a mesh, got a cutter, which only sensors are";
  return mesh.radius > 0 ? "expected a mesh without a radius, which only sensors have" : "";
}

QuerySpec queryFrom(const JsonValue& query, const Workload& world, std::span<const std::array<double, 3>> bases) {
  static const auto withFields = [](std::vector<std::string_view> known, bool ofChains) {
    for (const QueryField& field : queryFields()) {
      if (field.chain || !ofChains) known.emplace_back(field.name);
    }
    return known;
  };
  static const std::vector<std::string_view> kKnown = withFields({"id", "scene", "batch", "sensor", "dir", "D",
                                                                  "motion", "turn", "mode"},
                                                                 false),
                                             kOfChains = withFields(
                                                 {"id", "scene", "batch", "chain", "from", "to", "base"}, true);
  requireKnownKeys(query, query.has("chain") ? kOfChains : kKnown);
  QuerySpec spec;
  spec.id = query.member("id").string();
  if (!query.has("scene")) {
    query.refuse("expected the key \"scene\", the number of the query's scene, from 0, which is missing");
  }
  spec.scene = query.member("scene").index(world.scenes.size(), "scenes");
  query.ifHas("batch", [&](const JsonValue& batch) { spec.batch = batch.wholeNumber<uint64_t>(); });
  if (query.has("chain")) {
    readChainWay(query, world, spec);
    readFields(query, world.objectCount(spec.scene), spec);
    checkChainQuery(query, world, spec);
    return spec;
  }
  spec.setSensor(instanceFrom(query.member("sensor"), bases));
  const char* const step = query.has("motion") ? "motion" : "turn";
  if (query.has(step)) {
    for (const char* other : {"dir", "D"}) {
      if (!query.has(other)) continue;
      query.member(other).refuse("expected either \"dir\" and \"D\" or \"" + std::string(step) + "\", got both");
    }
    query.ifHas("motion", [&](const JsonValue& motion) {
      if (motion.size() != 3) motion.expected("3 numbers");
      spec.motion = motionFrom(motion, 0);
      for (size_t k = 0; k < 3 && query.has("turn"); ++k) {
        if (std::abs((*spec.motion)[k]) > 0x1p800) motion[k].expected("a number of at most 2^800 beside \"turn\"");
      }
    });
    query.ifHas("turn", [&](const JsonValue& turn) {
      if (!turn.has("to")) {
        spec.turn = turnFrom(turn);
        return;
      }
      if (spec.motion) query.member("motion").refuse("expected none beside a turn to a pose, which says it");
      readTurnTo(turn, world.meshes[spec.mesh], bases[spec.mesh], spec);
    });
  } else {
    const JsonValue direction = query.member("dir");
    spec.direction = vectorFrom(direction);
    if (spec.direction == std::array<double, 3>{}) direction.expected("a vector that is not zero");
    const JsonValue distance = query.member("D");
    spec.distance = distance.numberFrom0();
    if (spec.distance > 0x1p1000 && !world.scenes[spec.scene].motions.empty()) {
      distance.expected("at most 2^1000 in a scene with motions");
    }
  }
  readFields(query, world.objectCount(spec.scene), spec);
  spec.clearance = withRadius(spec.clearance, world.meshes[spec.mesh].radius);
  if (const auto [key, wrong] = conflictIn(world, spec); !wrong.empty()) query.member(key.c_str()).refuse(wrong);
  query.ifHas("mode", [&](const JsonValue& mode) {
    const std::string name = mode.string();
    spec.mode = mode.guard([&] { return modeFrom(name); });
    const std::string reason = exactOnly(world, spec);
    if (spec.mode == AnswerMode::sampled && !reason.empty())
      mode.expected("contact or reference, as " + reason + " needs");
  });
  return spec;
}

std::pair<std::string, std::string> conflictIn(const Workload& workload, const QuerySpec& query) {
  struct Option {
    const char* key;
    bool isGiven, goesWithCutter, goesWithTurn, goesWithLeaving;
  };
  // A turn has no length.
  const Option options[] = {{"turn", query.turn.has_value(), false, true, true},
                            {"speed", query.speed.has_value(), true, false, true},
                            {"ignore_leaving", query.ignoreLeaving, false, query.clearance == 0, true},
                            {"skip_overlapping", query.skipOverlapping, false, true, true},
                            {"closest", query.closest, false, false, false},
                            {"exit", query.exit, false, false, false}};
  const bool ofCutter = isCutter(workload, query);
  for (const Option& option : options) {
    if (!option.isGiven) continue;
    if (ofCutter && !option.goesWithCutter) return {option.key, "expected none with a cutter"};
    if (query.turn && !option.goesWithTurn) {
      const bool leaves = option.key == std::string_view("ignore_leaving");
      return {option.key, leaves ? "expected none beside a turn and a clearance" : "expected none beside a turn"};
    }
    if (query.ignoreLeaving && !option.goesWithLeaving) return {option.key, "expected none beside \"ignore_leaving\""};
  }
  return {};
}

std::string exactOnly(const Workload& workload, const QuerySpec& query) {
  if (isCutter(workload, query)) return "a cutter";
  if (query.turn) return "\"turn\"";
  if (query.motion) return "\"motion\"";
  if (!workload.scenes[query.scene].motions.empty()) return "a scene with \"motions\"";
  const QueryField* const field = exactOnly(query);
  return field ? "\"" + std::string(field->name) + "\"" : "";
}

const char* nameOf(AnswerMode mode) {
  constexpr const char* kNames[] = {"sampled", "contact", "reference"};
  return kNames[static_cast<size_t>(mode)];
}

AnswerMode modeFrom(std::string_view name) {
  for (AnswerMode mode : {AnswerMode::sampled, AnswerMode::contact, AnswerMode::reference}) {
    if (name == nameOf(mode)) return mode;
  }
  throw std::invalid_argument("expected mode sampled, contact or reference, got \"" + std::string(name) + "\"");
}

}  // namespace radar::tools
