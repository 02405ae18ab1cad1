#include "batch/binary_queries.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "batch/json_output.h"
#include "batch/query_file.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr double kLongestMotion = 0x1p1000;

template <class Value>
Value valueAt(const NpyArray& array, uint64_t place) {
  Value value;
  std::memcpy(&value, array.bytes.data() + place * sizeof value, sizeof value);
  return value;
}

std::string text(double value) {
  std::string digits;
  if (std::isfinite(value)) {
    appendNumber(digits, value);
    return digits;
  }
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

// An integer array's number; a negative one as 2^64 - 1, which no limit allows.
uint64_t integerAt(const NpyArray& array, uint64_t place) {
  const auto widen = [](int64_t value) { return value < 0 ? ~uint64_t{0} : static_cast<uint64_t>(value); };
  const bool isSigned = array.kind == 'i';
  switch (array.size) {
    case 1:
      return isSigned ? widen(valueAt<int8_t>(array, place)) : valueAt<uint8_t>(array, place);
    case 2:
      return isSigned ? widen(valueAt<int16_t>(array, place)) : valueAt<uint16_t>(array, place);
    case 4:
      return isSigned ? widen(valueAt<int32_t>(array, place)) : valueAt<uint32_t>(array, place);
    default:
      return isSigned ? widen(valueAt<int64_t>(array, place)) : valueAt<uint64_t>(array, place);
  }
}

}  // namespace

BinaryQueries::BinaryQueries(const std::filesystem::path& file, const Workload& world, size_t meshes)
    : name_(file.string()), world_(world), meshes_(meshes), file_(file) {
  const auto& arrays = file_.arrays();
  const auto mesh = arrays.find("mesh");
  if (mesh == arrays.end()) throw InputError(name_, "mesh", "expected this array, which is missing");
  if (mesh->second.shape.size() != 1) {
    throw InputError(name_, "mesh", "expected integers of shape (N,), got " + inWords(mesh->second));
  }
  count_ = mesh->second.shape[0];
  mesh_ = column("mesh", "iu", {}, true);
  pose_ = column("pose", "f", {3, 4}, true);
  const bool isStep = arrays.contains("motion");
  motion_ = column("motion", "f", {3}, false);
  direction_ = column("dir", "f", {3}, !isStep);
  distance_ = column("D", "f", {}, !isStep);
  if (isStep && (direction_ || distance_)) {
    throw InputError(name_, "motion", "expected either \"dir\" and \"D\" or \"motion\", got both");
  }
  scene_ = column("scene", "iu", {}, false);
  batch_ = column("batch", "iu", {}, false);
  const auto exclude = arrays.find("exclude");
  const bool hasWidth = exclude != arrays.end() && exclude->second.shape.size() == 2;
  exclude_ = column("exclude", "iu", {hasWidth ? exclude->second.shape[1] : 1}, false);
  mask_ = column("mask", "iu", {}, false);
  decide_ = column("decide", "b", {}, false);
  mode_ = column("mode", "iu", {}, false);
  speed_ = column("speed", "f", {}, false);
  tolerance_ = column("tolerance", "f", {}, false);
  ignoreLeaving_ = column("ignore_leaving", "b", {}, false);
  slack_ = column("slack", "f", {}, false);
  skipOverlapping_ = column("skip_overlapping", "b", {}, false);
  hits_ = column("hits", "iu", {}, false);
  clearance_ = column("clearance", "f", {}, false);
  requireKnownNames();
}

BinaryQueries::Column BinaryQueries::column(const char* name, const char* kinds, std::vector<uint64_t> shape,
                                            bool required) {
  known_.emplace_back(name);
  Column column{name, nullptr, 1};
  for (const uint64_t length : shape) column.width *= length;
  const auto found = file_.arrays().find(name);
  if (found == file_.arrays().end()) {
    if (required) throw InputError(name_, name, "expected this array, which is missing");
    return column;
  }
  const NpyArray& array = found->second;
  shape.insert(shape.begin(), count_);
  if (std::string_view(kinds).find(array.kind) == std::string_view::npos || array.shape != shape) {
    const char* const type = *kinds == 'f' ? "float32 or float64" : *kinds == 'b' ? "booleans" : "integers";
    NpyArray expected{array.kind, array.size, shape, {}};
    const std::string words = inWords(expected);
    throw InputError(
        name_, name,
        std::string("expected ") + type + words.substr(words.find(" of shape")) + ", got " + inWords(array));
  }
  column.array = &array;
  return column;
}

void BinaryQueries::requireKnownNames() const {
  for (const auto& [name, array] : file_.arrays()) {
    if (std::ranges::count(known_, name) > 0) continue;
    std::string list;
    for (const std::string& one : known_) list += (list.empty() ? "" : ", ") + one;
    throw InputError(name_, name, "expected one of the arrays " + list);
  }
}

void BinaryQueries::refuse(const Column& column, uint64_t index, const std::string& expected) const {
  throw InputError(name_, column.name + "[" + std::to_string(index) + "]", expected);
}

double BinaryQueries::number(const Column& column, uint64_t index, uint64_t part) const {
  const uint64_t place = index * column.width + part;
  return column.array->size == 4 ? valueAt<float>(*column.array, place) : valueAt<double>(*column.array, place);
}

double BinaryQueries::finite(const Column& column, uint64_t index, uint64_t part) const {
  const double value = number(column, index, part);
  if (!std::isfinite(value)) refuse(column, index, "expected finite numbers, got " + text(value));
  return value;
}

std::optional<double> BinaryQueries::given(const Column& column, uint64_t index) const {
  if (!column) return std::nullopt;
  const double value = number(column, index);
  if (std::isnan(value)) return std::nullopt;
  if (!(value >= 0 && std::isfinite(value))) {
    refuse(column, index, "expected a finite number of 0 or more, or nan for none, got " + text(value));
  }
  return value;
}

bool BinaryQueries::flag(const Column& column, uint64_t index) const {
  return column && column.array->bytes[index] != 0;
}

uint64_t BinaryQueries::whole(const Column& column, uint64_t index, uint64_t most, const std::string& expected) const {
  const uint64_t value = integerAt(*column.array, index);
  if (value > most || (value == ~uint64_t{0} && column.array->kind == 'i'))
    refuse(column, index, "expected " + expected);
  return value;
}

void BinaryQueries::readMove(QuerySpec& query, uint64_t index) const {
  if (motion_) {
    std::array<double, 3>& motion = query.motion.emplace();
    for (uint64_t k = 0; k < 3; ++k) motion[k] = finite(motion_, index, k);
    if (std::ranges::any_of(motion, [](double x) { return std::abs(x) > kLongestMotion; })) {
      refuse(motion_, index, "expected numbers of at most 2^1000");
    }
    return;
  }
  for (uint64_t k = 0; k < 3; ++k) query.direction[k] = finite(direction_, index, k);
  if (query.direction == std::array<double, 3>{}) refuse(direction_, index, "expected a vector that is not zero");
  query.distance = finite(distance_, index);
  if (query.distance < 0) refuse(distance_, index, "expected a number of 0 or more, got " + text(query.distance));
  if (query.distance > kLongestMotion && !world_.scenes[query.scene].motions.empty()) {
    refuse(distance_, index, "expected at most 2^1000 in a scene with motions");
  }
}

QuerySpec BinaryQueries::read(uint64_t index) const {
  const auto among = [](size_t count, const char* what) {
    return "a whole number that names one of the " + std::to_string(count) + " " + what + ", from 0";
  };
  QuerySpec query;
  query.id = std::to_string(index);
  const size_t scenes = world_.scenes.size();
  if (scenes == 0) throw InputError(name_, "", "expected a query file with a scene");
  if (scene_) query.scene = static_cast<uint32_t>(whole(scene_, index, scenes - 1, among(scenes, "scenes")));
  if (batch_) query.batch = whole(batch_, index, ~uint64_t{0}, "a whole number from 0");
  if (meshes_ == 0) throw InputError(name_, "mesh", "expected a query file with a mesh");
  query.mesh = static_cast<uint32_t>(whole(mesh_, index, meshes_ - 1, among(meshes_, "meshes")));
  for (uint64_t k = 0; k < 12; ++k) query.worldFromMesh.m[k] = number(pose_, index, k);
  if (std::string wrong = validate(query.worldFromMesh); !wrong.empty()) refuse(pose_, index, wrong);
  readMove(query, index);
  for (uint64_t k = 0; exclude_ && k < exclude_.width; ++k) {
    const uint64_t object = integerAt(*exclude_.array, index * exclude_.width + k);
    if (object == ~uint64_t{0}) continue;
    const uint32_t objects = world_.objectCount(query.scene);
    if (object >= objects) refuse(exclude_, index, "expected -1 or " + among(objects, "objects of the query's scene"));
    query.exclude.push_back(static_cast<uint32_t>(object));
  }
  constexpr uint64_t kMost32 = ~0u;
  if (mask_) query.mask = static_cast<uint32_t>(whole(mask_, index, kMost32, "a whole number from 0 to 2^32 - 1"));
  query.anyHit = flag(decide_, index);
  query.speed = given(speed_, index);
  if (query.speed == 0.0) refuse(speed_, index, "expected a number above 0, or nan for none, got 0");
  query.tolerance = given(tolerance_, index);
  query.ignoreLeaving = flag(ignoreLeaving_, index);
  query.slack = given(slack_, index);
  query.skipOverlapping = flag(skipOverlapping_, index);
  if (hits_) {
    const uint64_t hits = whole(hits_, index, kMost32 - 1, "a whole number from 1 to 2^32 - 2, or 0 for all");
    query.hits = hits == 0 ? kAllHits : static_cast<uint32_t>(hits);
    if (query.hits > 1 && query.anyHit) refuse(hits_, index, "expected 1 beside \"decide\"");
  }
  query.clearance = given(clearance_, index).value_or(0);
  if (mode_) {
    query.mode = static_cast<AnswerMode>(whole(mode_, index, 2, "0 for sampled, 1 for contact or 2 for reference"));
    const std::string reason = exactOnly(world_, query);
    if (query.mode == AnswerMode::sampled && !reason.empty()) {
      refuse(mode_, index, "expected contact or reference, as " + reason + " needs");
    }
  }
  return query;
}

void BinaryQueries::addTo(Fingerprint& fingerprint) const {
  for (const auto& [name, array] : file_.arrays()) {
    const std::string head = name + ": " + inWords(array);
    fingerprint.add(std::as_bytes(std::span(head)));
    fingerprint.add(std::as_bytes(std::span(array.bytes)));
  }
}

void writeBinaryQueries(std::span<const QuerySpec> queries, const std::filesystem::path& file) {
  NpzWriter writer(file);
  const uint64_t count = queries.size();
  const auto add = [&]<class Value>(const char* name, const char* descr, std::vector<uint64_t> shape, const Value&,
                                    const auto& append) {
    std::vector<Value> values;
    for (const QuerySpec& query : queries) append(values, query);
    shape.insert(shape.begin(), count);
    writer.add(name, descr, shape, std::as_bytes(std::span(values)));
  };
  // What every query leaves at its default needs no array.
  const auto addIf = [&]<class Value>(const auto& isDefault, const char* name, const char* descr, const Value& zero,
                                      const auto& valueOf) {
    if (std::ranges::all_of(queries, isDefault)) return;
    add(name, descr, {}, zero, [&](auto& values, const QuerySpec& query) { values.push_back(valueOf(query)); });
  };
  const auto addOptional = [&](const char* name, std::optional<double> QuerySpec::*member) {
    addIf([&](const QuerySpec& query) { return !(query.*member); }, name, "'<f8'", 0.0,
          [&](const QuerySpec& query) { return (query.*member).value_or(std::nan("")); });
  };
  const auto addFlag = [&](const char* name, bool QuerySpec::*member) {
    addIf([&](const QuerySpec& query) { return !(query.*member); }, name, "'|b1'", uint8_t{0},
          [&](const QuerySpec& query) { return static_cast<uint8_t>(query.*member); });
  };
  const auto appendAll = [](auto& values, const auto& more) { values.insert(values.end(), more.begin(), more.end()); };

  const bool steps = std::ranges::any_of(queries, [](const QuerySpec& query) { return query.motion.has_value(); });
  if (steps && !std::ranges::all_of(queries, [](const QuerySpec& query) { return query.motion.has_value(); })) {
    throw std::runtime_error(file.string() + ": expected either motions or directions in all queries, got both");
  }
  const QuerySpec usual;
  add("mesh", "'<u4'", {}, uint32_t{0}, [](auto& values, const QuerySpec& query) { values.push_back(query.mesh); });
  add("pose", "'<f8'", {3, 4}, 0.0,
      [&](auto& values, const QuerySpec& query) { appendAll(values, query.worldFromMesh.m); });
  if (steps) {
    add("motion", "'<f8'", {3}, 0.0, [&](auto& values, const QuerySpec& query) { appendAll(values, *query.motion); });
  } else {
    add("dir", "'<f8'", {3}, 0.0, [&](auto& values, const QuerySpec& query) { appendAll(values, query.direction); });
    add("D", "'<f8'", {}, 0.0, [](auto& values, const QuerySpec& query) { values.push_back(query.distance); });
  }
  addIf([](const QuerySpec& query) { return query.scene == 0; }, "scene", "'<u4'", uint32_t{0},
        [](const QuerySpec& query) { return query.scene; });
  addIf([](const QuerySpec& query) { return query.batch == 0; }, "batch", "'<u8'", uint64_t{0},
        [](const QuerySpec& query) { return query.batch; });
  size_t width = 0;
  for (const QuerySpec& query : queries) width = std::max(width, query.exclude.size());
  if (width > 0) {
    add("exclude", "'<i8'", {width}, int64_t{0}, [&](auto& values, const QuerySpec& query) {
      appendAll(values, query.exclude);
      values.insert(values.end(), width - query.exclude.size(), -1);
    });
  }
  addIf([&](const QuerySpec& query) { return query.mask == usual.mask; }, "mask", "'<u4'", uint32_t{0},
        [](const QuerySpec& query) { return query.mask; });
  addFlag("decide", &QuerySpec::anyHit);
  addOptional("speed", &QuerySpec::speed);
  addOptional("tolerance", &QuerySpec::tolerance);
  addFlag("ignore_leaving", &QuerySpec::ignoreLeaving);
  addOptional("slack", &QuerySpec::slack);
  addFlag("skip_overlapping", &QuerySpec::skipOverlapping);
  addIf([](const QuerySpec& query) { return query.hits == 1; }, "hits", "'<u4'", uint32_t{0},
        [](const QuerySpec& query) { return query.hits == kAllHits ? 0 : query.hits; });
  addIf([](const QuerySpec& query) { return query.clearance == 0; }, "clearance", "'<f8'", 0.0,
        [](const QuerySpec& query) { return query.clearance; });
  addIf([](const QuerySpec& query) { return !query.mode; }, "mode", "'|u1'", uint8_t{0},
        [&](const QuerySpec& query) {
          if (!query.mode) throw std::runtime_error(file.string() + ": expected a mode in all queries or in none");
          return static_cast<uint8_t>(*query.mode);
        });
  writer.finish();
}

}  // namespace radar::tools
