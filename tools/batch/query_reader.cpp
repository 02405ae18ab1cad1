#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <unordered_set>

#include "batch/json_text.h"
#include "batch/query_file.h"
#include "import/mesh_import.h"

namespace radar::tools {

namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::string_view kLater[] = {"motion", "motions", "deforms", "margin", "top", "rotation"};
constexpr uint64_t kMostBits = std::numeric_limits<uint32_t>::max();

std::string readWhole(const std::filesystem::path& file, const char* kind) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(file.string(), "", std::string("expected ") + kind + ", got a folder");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string(), "", std::string("expected ") + kind + ", got no readable file");
  return {std::istreambuf_iterator<char>(stream), {}};
}

void requireKnownKeys(const JsonValue& object, std::initializer_list<std::string_view> known) {
  object.requireObject();
  for (const auto& [key, value] : object.json().items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    if (std::find(std::begin(kLater), std::end(kLater), key) != std::end(kLater)) {
      object.member(key.c_str()).refuse("expected no such key: \"" + key + "\" is not available in this version");
    }
    std::string list;
    for (std::string_view name : known) list.append(list.empty() ? "" : ", ").append(name);
    object.member(key.c_str()).refuse("expected one of the keys " + list + ", got \"" + key + "\"");
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : file_(file), name_(file.string()), warnings_(warnings) {}

  Workload read();

 private:
  void readMeshes(const JsonValue& list);
  SceneSpec readScene(const JsonValue& scene) const;
  Instance readInstance(const JsonValue& list) const;
  std::vector<Instance> readInstanceFile(const std::filesystem::path& file) const;
  QuerySpec readQuery(const JsonValue& query) const;
  std::vector<ObjectMask> readMasks(const JsonValue& list, size_t objects) const;

  std::filesystem::path file_;
  std::string name_;
  std::vector<std::string>& warnings_;
  Workload workload_;
};

Workload Reader::read() {
  const nlohmann::json document = parseJson(name_, readWhole(file_, "a query file"));
  const JsonValue root(name_, document);
  requireKnownKeys(root, {"format", "meshes", "scenes", "queries"});
  const JsonValue format = root.member("format");
  if (format.string() != "cyber-radar-queries-1") format.expected("\"cyber-radar-queries-1\"");

  readMeshes(root.member("meshes"));

  const JsonValue scenes = root.member("scenes");
  std::unordered_set<std::string> ids;
  for (size_t i = 0, count = scenes.arraySize(); i < count; ++i) {
    const JsonValue scene = scenes.element(i);
    workload_.scenes.push_back(readScene(scene));
    if (scene.has("id") && !ids.insert(workload_.scenes.back().id).second) {
      scene.member("id").expected("an id that no other scene has");
    }
  }
  ids.clear();
  const JsonValue queries = root.member("queries");
  workload_.queries.reserve(queries.arraySize());
  for (size_t i = 0, count = queries.arraySize(); i < count; ++i) {
    const JsonValue query = queries.element(i);
    workload_.queries.push_back(readQuery(query));
    if (!ids.insert(workload_.queries.back().id).second) {
      query.member("id").expected("an id that no other query has");
    }
  }
  return std::move(workload_);
}

void Reader::readMeshes(const JsonValue& list) {
  for (size_t i = 0, count = list.arraySize(); i < count; ++i) {
    const JsonValue value = list.element(i);
    const std::string name = value.string();
    try {
      workload_.meshes.push_back(readMesh(file_.parent_path() / name, warnings_));
    } catch (const InputError& error) {
      value.refuse(error.what());
    }
    workload_.meshes.back().name = name;
  }
}

SceneSpec Reader::readScene(const JsonValue& scene) const {
  requireKnownKeys(scene, {"id", "base", "instances", "instances_file", "masks"});
  SceneSpec spec;
  if (scene.has("id")) spec.id = scene.member("id").string();
  if (scene.has("base")) {
    const JsonValue base = scene.member("base");
    spec.base = base.index(workload_.scenes.size(), "scenes before this one");
    if (workload_.scenes[*spec.base].base) base.expected("a scene that has no base itself");
  }
  if (scene.has("instances") && scene.has("instances_file")) {
    scene.refuse("expected either \"instances\" or \"instances_file\", got both");
  }
  if (scene.has("instances_file")) {
    const JsonValue file = scene.member("instances_file");
    try {
      spec.instances = readInstanceFile(file_.parent_path() / file.string());
    } catch (const InputError& error) {
      file.refuse(error.what());
    }
  } else {
    const JsonValue list = scene.member("instances");
    spec.instances.reserve(list.arraySize());
    for (size_t i = 0, count = list.arraySize(); i < count; ++i) {
      spec.instances.push_back(readInstance(list.element(i)));
    }
  }
  if (scene.has("masks")) {
    const size_t still = spec.base ? workload_.scenes[*spec.base].instances.size() : 0;
    spec.masks = readMasks(scene.member("masks"), still + spec.instances.size());
  }
  return spec;
}

std::vector<ObjectMask> Reader::readMasks(const JsonValue& list, size_t objects) const {
  std::vector<ObjectMask> masks;
  std::unordered_set<uint32_t> named;
  for (size_t i = 0, count = list.arraySize(); i < count; ++i) {
    const JsonValue pair = list.element(i);
    if (pair.arraySize() != 2) pair.expected("[object, bits]");
    const JsonValue object = pair.element(0), bits = pair.element(1);
    masks.emplace_back(object.index(objects, "objects"), static_cast<uint32_t>(bits.wholeNumber(kMostBits)));
    if (!named.insert(masks.back().first).second) object.expected("each object once");
  }
  return masks;
}

Instance Reader::readInstance(const JsonValue& list) const {
  const size_t count = list.arraySize();
  if (count != 1 && count != 13) list.expected("a mesh index, alone or followed by 12 numbers");
  Instance instance;
  instance.mesh = list.element(0).index(workload_.meshes.size(), "meshes");
  for (size_t i = 1; i < count; ++i) instance.worldFromMesh.m[i - 1] = list.element(i).number();
  if (std::string wrong = validate(instance.worldFromMesh); !wrong.empty()) list.refuse(wrong);
  return instance;
}

/// One line of an instance file; `numbers` holds 13 at most. Returns how many there are, 0 if one is none.
size_t readNumbers(std::string_view line, std::span<double> numbers) {
  size_t count = 0;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.empty()) return count;
    if (count == numbers.size()) return 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[count]);
    const size_t length = static_cast<size_t>(end - line.data());
    if (error != std::errc() || (length < line.size() && kBlanks.find(line[length]) == kBlanks.npos)) return 0;
    line.remove_prefix(length);
    ++count;
  }
}

std::vector<Instance> Reader::readInstanceFile(const std::filesystem::path& file) const {
  const std::string content = readWhole(file, "an instance file");
  std::string_view rest = content;
  std::vector<Instance> instances;
  // Only the last line may be blank.
  rest = rest.substr(0, rest.find_last_not_of(" \t\r\n") + 1);
  for (size_t number = 1; !rest.empty(); ++number) {
    const size_t length = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const auto refuse = [&](const std::string& problem) {
      throw InputError(file.string(), "line " + std::to_string(number), problem);
    };
    std::array<double, 13> numbers{};
    const size_t count = readNumbers(line, numbers);
    if (count != 1 && count != 13) {
      refuse("expected a mesh index, alone or followed by 12 numbers, separated by blanks, got \"" +
             std::string(line.substr(0, 60)) + "\"");
    }
    const size_t meshes = workload_.meshes.size();
    if (!(numbers[0] >= 0 && numbers[0] < double(meshes) && std::floor(numbers[0]) == numbers[0])) {
      refuse("expected a whole number that names one of the " + std::to_string(meshes) + " meshes, from 0, got \"" +
             std::string(line.substr(0, std::min(line.find(' '), size_t{60}))) + "\"");
    }
    Instance instance{static_cast<uint32_t>(numbers[0]), {}};
    if (count == 13) std::copy(numbers.begin() + 1, numbers.end(), instance.worldFromMesh.m.begin());
    if (std::string wrong = validate(instance.worldFromMesh); !wrong.empty()) refuse(wrong);
    instances.push_back(instance);
  }
  return instances;
}

QuerySpec Reader::readQuery(const JsonValue& query) const {
  requireKnownKeys(
      query, {"id", "scene", "batch", "sensor", "exclude", "dir", "D", "mask", "decide", "mode", "speed", "tolerance"});
  QuerySpec spec;
  spec.id = query.member("id").string();
  spec.scene = query.member("scene").index(workload_.scenes.size(), "scenes");
  if (query.has("batch")) spec.batch = query.member("batch").wholeNumber(std::numeric_limits<uint64_t>::max());
  spec.sensor = readInstance(query.member("sensor"));
  if (query.has("exclude")) {
    const JsonValue list = query.member("exclude");
    const size_t objects = workload_.objectCount(spec.scene);
    for (size_t i = 0, count = list.arraySize(); i < count; ++i) {
      spec.exclude.push_back(list.element(i).index(objects, "objects of the query's scene"));
    }
  }
  const JsonValue direction = query.member("dir");
  if (direction.arraySize() != 3) direction.expected("3 numbers");
  for (size_t k = 0; k < 3; ++k) spec.direction[k] = direction.element(k).number();
  if (spec.direction == std::array<double, 3>{}) direction.expected("a vector that is not zero");
  const JsonValue distance = query.member("D");
  spec.distance = distance.number();
  if (spec.distance < 0) distance.expected("a number of 0 or more");
  if (query.has("mask")) spec.mask = static_cast<uint32_t>(query.member("mask").wholeNumber(kMostBits));
  if (query.has("decide")) spec.anyHit = query.member("decide").boolean();
  if (query.has("mode")) {
    const JsonValue mode = query.member("mode");
    try {
      spec.mode = modeFrom(mode.string());
    } catch (const std::invalid_argument& error) {
      mode.refuse(error.what());
    }
  }
  if (query.has("speed")) {
    const JsonValue speed = query.member("speed");
    spec.speed = speed.number();
    if (*spec.speed <= 0) speed.expected("a number above 0");
  }
  if (query.has("tolerance")) {
    const JsonValue tolerance = query.member("tolerance");
    spec.tolerance = tolerance.number();
    if (*spec.tolerance < 0) tolerance.expected("a number of 0 or more");
  }
  return spec;
}

}  // namespace

Workload readQueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  return Reader(file, warnings).read();
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
