#include "batch/binary_queries.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>

#include "batch/atomic_file.h"
#include "batch/json_output.h"
#include "batch/query_file.h"
#include "import/input_error.h"

#include "import/float_vertices.h"
namespace radar::tools {

namespace {

constexpr double kLongestMotion = 0x1p1000, kFarthestTurn = 0x1p800;

std::string among(size_t count, const char* what) {
  return "a whole number that names one of the " + std::to_string(count) + " " + what + ", from 0";
}

}  // namespace

BinaryQueries::BinaryQueries(const std::filesystem::path& file, const Workload& world,
                             std::vector<std::array<double, 3>> bases, bool placesOnly)
    : name_(file.string()), world_(world), bases_(std::move(bases)), columns_(file) {
  mesh_ = column("mesh", "iu", {}, true);
  pose_ = column("pose", "f", {3, 4}, true);
  if (placesOnly) {
    requireKnownColumns();
    return;
  }
  motion_ = column("motion", "f", {3}, false);
  const bool turns =
      std::ranges::any_of(columns_.all(), [](const Column& given) { return given.name.starts_with("turn_"); });
  axis_ = column("turn_axis", "f", {3}, turns);
  angle_ = column("turn_angle", "f", {}, turns);
  centre_ = column("turn_centre", "f", {3}, turns);
  const Column* const step = motion_ ? motion_ : angle_;
  direction_ = column("dir", "f", {3}, !step);
  distance_ = column("D", "f", {}, !step);
  if (step && (direction_ || distance_)) {
    throw InputError(name_, step->name, "expected either \"dir\" and \"D\" or \"" + step->name + "\", got both");
  }
  scene_ = column("scene", "iu", {}, false);
  batch_ = column("batch", "iu", {}, false);
  mode_ = column("mode", "iu", {}, false);
  for (const QueryField& field : queryFields()) {
    const Column* const found = columns_.find(field.name);
    fields_.push_back(column(field.name,
                             field.kind() == 'b'   ? "b"
                             : field.kind() == 'f' ? "f"
                                                   : "iu",
                             field.kind() == 'o' && found ? found->shape : std::vector<uint64_t>(), false));
  }
  requireKnownColumns();
}

void BinaryQueries::requireKnownColumns() const {
  for (const Column& given : columns_.all()) {
    if (std::ranges::count(known_, given.name) > 0) continue;
    std::string list;
    for (const std::string& one : known_) list += (list.empty() ? "" : ", ") + one;
    throw InputError(name_, given.name, "expected one of the columns " + list);
  }
}

const Column* BinaryQueries::column(const char* name, const char* kinds, const std::vector<uint64_t>& shape,
                                    bool required) {
  known_.emplace_back(name);
  const Column* const found = columns_.find(name);
  if (!found && required) throw InputError(name_, name, "expected this column, which is missing");
  if (found && (std::string_view(kinds).find(found->kind) == std::string_view::npos || found->shape != shape)) {
    const std::string words = Column{.kind = 'b', .shape = shape}.type();
    throw InputError(name_, name,
                     std::string("expected ") +
                         (*kinds == 'f'   ? "float32 or float64"
                          : *kinds == 'b' ? "booleans"
                                          : "integers") +
                         words.substr(std::strlen("bool")) + ", got " + found->type());
  }
  return found;
}

void BinaryQueries::refuse(const std::string& key, uint64_t index, const std::string& problem) const {
  const std::string column = key == "sensor" ? "pose" : key == "turn" ? "turn_angle" : key;
  throw InputError(name_, column + "[" + std::to_string(index) + "]", problem);
}

void BinaryQueries::refuse(const Column& column, uint64_t index, const std::string& problem) const {
  refuse(column.name, index, problem);
}

double BinaryQueries::finite(const Column& column, uint64_t index, uint64_t part) const {
  const double value = column.real(index, part);
  if (!std::isfinite(value)) refuse(column, index, "expected finite numbers, got " + inShortest(value));
  return value;
}

uint64_t BinaryQueries::whole(const Column& column, uint64_t index, uint64_t most, const std::string& expected) const {
  const uint64_t value = column.whole(index);
  if (value > most || (value == ~uint64_t{0} && column.kind == 'i')) refuse(column, index, "expected " + expected);
  return value;
}

std::array<double, 3> BinaryQueries::vector(const Column& column, uint64_t index, double most,
                                            const char* mostInWords) const {
  std::array<double, 3> read{};
  for (uint64_t k = 0; k < 3; ++k) read[k] = finite(column, index, k);
  if (std::ranges::any_of(read, [&](double x) { return std::abs(x) > most; })) {
    refuse(column, index, std::string("expected numbers of at most ") + mostInWords);
  }
  return read;
}

void BinaryQueries::readTurn(QuerySpec& query, uint64_t index) const {
  if (!angle_) return;
  if (std::isnan(angle_->real(index))) {
    if (!motion_) refuse(*angle_, index, "expected a finite number, or nan beside \"motion\", got nan");
    return;
  }
  Turn& turn = query.turn.emplace();
  turn.angle = finite(*angle_, index);
  if (std::abs(turn.angle) > 0x1p16) refuse(*angle_, index, "expected a number of at most 2^16");
  turn.axis = vector(*axis_, index);
  if (turn.angle != 0 && turn.axis == std::array<double, 3>{}) {
    refuse(*axis_, index, "expected a vector that is not zero");
  }
  turn.centre = vector(*centre_, index, kFarthestTurn, "2^800");
}

void BinaryQueries::readMove(QuerySpec& query, uint64_t index) const {
  readTurn(query, index);
  if (motion_ && query.turn) query.motion = vector(*motion_, index, kFarthestTurn, "2^800 beside a turn");
  if (motion_ && !query.turn) query.motion = vector(*motion_, index, kLongestMotion, "2^1000");
  if (takesStep(query)) return;
  query.direction = vector(*direction_, index);
  if (query.direction == std::array<double, 3>{}) refuse(*direction_, index, "expected a vector that is not zero");
  query.distance = finite(*distance_, index);
  if (query.distance < 0)
    refuse(*distance_, index, "expected a number of 0 or more, got " + inShortest(query.distance));
  if (query.distance > kLongestMotion && !world_.scenes[query.scene].motions.empty()) {
    refuse(*distance_, index, "expected at most 2^1000 in a scene with motions");
  }
}

void BinaryQueries::readField(const QueryField& field, const Column& column, uint64_t index, QuerySpec& query) const {
  if (field.kind() == 'o') {
    const uint32_t objects = world_.objectCount(query.scene);
    for (uint64_t k = 0; k < column.width(); ++k) {
      const uint64_t object = column.whole(index, k);
      if (object == ~uint64_t{0}) continue;
      if (object >= objects) refuse(column, index, "expected -1 or " + among(objects, "objects of the query's scene"));
      query.exclude.push_back(static_cast<ObjectId>(object));
    }
    return;
  }
  const bool isWhole = field.kind() == 'u', isReal = field.kind() == 'f';
  const double given = isReal ? column.real(index) : isWhole ? double(column.whole(index)) : column.flag(index);
  if (std::isnan(given) || setValue(query, field, field.word && given == 0 ? HUGE_VAL : given)) return;
  refuse(column, index,
         "expected " + expectedFor(field) +
             (isReal       ? ", or nan for none, got " + inShortest(given)
              : field.word ? ", which is 0"
                           : ""));
}

Instance BinaryQueries::placed(uint64_t index) const {
  if (bases_.empty()) throw InputError(name_, "mesh", "expected a query file with a mesh");
  Instance instance;
  instance.mesh = static_cast<uint32_t>(whole(*mesh_, index, bases_.size() - 1, among(bases_.size(), "meshes")));
  for (uint64_t k = 0; k < 12; ++k) instance.worldFromMesh.m[k] = pose_->real(index, k);
  if (std::string wrong = validate(instance.worldFromMesh); !wrong.empty()) refuse(*pose_, index, wrong);
  instance.worldFromMesh = aboutBase(instance.worldFromMesh, bases_[instance.mesh]);
  return instance;
}

QuerySpec BinaryQueries::read(uint64_t index) const {
  QuerySpec query;
  query.id = std::to_string(index);
  const size_t scenes = world_.scenes.size();
  if (scenes == 0) throw InputError(name_, "", "expected a query file with a scene");
  if (scene_) query.scene = static_cast<uint32_t>(whole(*scene_, index, scenes - 1, among(scenes, "scenes")));
  if (batch_) query.batch = whole(*batch_, index, ~uint64_t{0}, "a whole number from 0");
  query.setSensor(placed(index));
  readMove(query, index);
  for (size_t i = 0; i < fields_.size(); ++i) {
    if (!fields_[i]) continue;
    readField(queryFields()[i], *fields_[i], index, query);
    if (query.hits > 1 && query.anyHit) refuse(*fields_[i], index, "expected 1 beside \"any_hit\"");
  }
  query.clearance = withRadius(query.clearance, world_.meshes[query.mesh].radius);
  const auto [key, wrong] = conflictIn(world_, query);
  if (!wrong.empty()) refuse(key, index, wrong);
  if (mode_) {
    query.mode = static_cast<AnswerMode>(whole(*mode_, index, 2, "0 for sampled, 1 for contact or 2 for reference"));
    const std::string reason = exactOnly(world_, query);
    if (query.mode == AnswerMode::sampled && !reason.empty()) {
      refuse(*mode_, index, "expected contact or reference, as " + reason + " needs");
    }
  }
  return query;
}

void writeBinaryQueries(std::span<const QuerySpec> queries, const std::filesystem::path& file) {
  std::string type, rows;
  std::vector<std::function<void(const QuerySpec&)>> parts;
  const auto add = [&](const char* name, const std::string& numbers, std::function<void(const QuerySpec&)> append) {
    type += (type.empty() ? "[('" : ", ('") + std::string(name) + "', " + numbers + ")";
    parts.push_back(std::move(append));
  };
  const auto put = [&](const auto& value) { appendBytes(rows, value); };
  // What every query leaves at its default needs no column.
  const auto some = [&](const auto& isGivenIn) { return std::ranges::any_of(queries, isGivenIn); };
  if (some([](const QuerySpec& query) { return query.chain.has_value(); })) {
    throw std::runtime_error(file.string() + ": expected queries of sensors alone, got one of a chain");
  }
  const auto isStep = [](const QuerySpec& query) { return takesStep(query); };
  const bool steps = some(isStep);
  if (steps && !std::ranges::all_of(queries, isStep)) {
    throw std::runtime_error(file.string() + ": expected either motions or directions in all queries, got both");
  }
  const bool moves = some([](const QuerySpec& query) { return query.motion.has_value(); });
  add("mesh", "'<u4'", [&](const QuerySpec& query) { put(query.mesh); });
  add("pose", "'<f8', (3, 4)", [&](const QuerySpec& query) { put(query.worldFromMesh.m); });
  if (moves) {
    add("motion", "'<f8', (3,)", [&](const QuerySpec& query) { put(query.motion.value_or(std::array<double, 3>{})); });
  }
  if (some([](const QuerySpec& query) { return query.turn.has_value(); })) {
    static constexpr Turn kStraight{.angle = std::numeric_limits<double>::quiet_NaN()};
    add("turn_axis", "'<f8', (3,)", [&](const QuerySpec& query) { put(query.turn.value_or(kStraight).axis); });
    add("turn_angle", "'<f8'", [&](const QuerySpec& query) { put(query.turn.value_or(kStraight).angle); });
    add("turn_centre", "'<f8', (3,)", [&](const QuerySpec& query) { put(query.turn.value_or(kStraight).centre); });
  }
  if (!steps) {
    add("dir", "'<f8', (3,)", [&](const QuerySpec& query) { put(query.direction); });
    add("D", "'<f8'", [&](const QuerySpec& query) { put(query.distance); });
  }
  if (some([](const QuerySpec& query) { return query.scene != 0; })) {
    add("scene", "'<u4'", [&](const QuerySpec& query) { put(query.scene); });
  }
  if (some([](const QuerySpec& query) { return query.batch != 0; })) {
    add("batch", "'<u8'", [&](const QuerySpec& query) { put(query.batch); });
  }
  if (some([](const QuerySpec& query) { return query.mode.has_value(); })) {
    add("mode", "'|u1'", [&](const QuerySpec& query) {
      if (!query.mode) throw std::runtime_error(file.string() + ": expected a mode in all queries or in none");
      put(static_cast<uint8_t>(*query.mode));
    });
  }
  size_t width = 0;
  for (const QuerySpec& query : queries) width = std::max(width, query.exclude.size());
  for (const QueryField& field : queryFields()) {
    if (!some([&](const QuerySpec& query) { return isGiven(query, field); })) continue;
    switch (field.kind()) {
      case 'b':
        add(field.name, "'|b1'", [&](const QuerySpec& query) { put(valueIn(query, field) != 0); });
        break;
      case 'u':
        add(field.name, "'<u4'", [&](const QuerySpec& query) {
          const double value = valueIn(query, field);
          put(std::isinf(value) ? 0u : static_cast<uint32_t>(value));
        });
        break;
      case 'f':
        add(field.name, "'<f8'", [&](const QuerySpec& query) { put(valueIn(query, field)); });
        break;
      default:
        add(field.name, "'<i8', (" + std::to_string(width) + ",)", [&](const QuerySpec& query) {
          for (size_t k = 0; k < width; ++k) put(k < query.exclude.size() ? int64_t{query.exclude[k]} : int64_t{-1});
        });
    }
  }
  for (const QuerySpec& query : queries) {
    for (const auto& append : parts) append(query);
  }
  writeAtomically(file, npyHeader(type + "]", queries.size()) + rows);
}

void writePlaced(std::span<const Instance> instances, const std::filesystem::path& file) {
  std::string rows;
  for (const Instance& instance : instances) {
    appendBytes(rows, instance.mesh);
    appendBytes(rows, instance.worldFromMesh.m);
  }
  writeAtomically(file, npyHeader("[('mesh', '<u4'), ('pose', '<f8', (3, 4))]", instances.size()) + rows);
}

}  // namespace radar::tools
