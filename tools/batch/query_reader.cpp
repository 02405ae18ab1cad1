#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <unordered_set>

#include "batch/binary_queries.h"
#include "batch/chain_json.h"
#include "batch/query_file.h"
#include "batch/query_json.h"
#include "batch/query_reader.h"
#include "import/float_vertices.h"
#include "import/mesh_import.h"
#include "import/regular_file.h"
#include "workloads/query_fields.h"

namespace radar::tools {

namespace {

/// A mesh file, or a node of one.
struct MeshSource {
  std::string name;  ///< as the query file says it
  std::filesystem::path path;
  double scale = 1;
};

double radiusFrom(const JsonValue& value) {
  const double radius = value.number();
  if (!(radius >= 0 && radius <= 0x1p1000)) value.expected("a number from 0 to 2^1000");
  return radius;
}

/// What radar/cutters.h makes: the numbers of each, in its order, the last of a cone's being 0 if missing.
struct CutterKind {
  const char* name;
  std::vector<const char*> numbers;
  Cutter (*make)(const std::vector<double>& n);
};
const std::vector<CutterKind>& cutterKinds() {
  using Numbers = const std::vector<double>&;
  static const std::vector<CutterKind> kinds{
      {"flat", {"radius", "length"}, [](Numbers n) { return flatCutter(n[0], n[1]); }},
      {"ball_cutter", {"radius", "length"}, [](Numbers n) { return ballCutter(n[0], n[1]); }},
      {"bull_nose", {"radius", "corner", "length"}, [](Numbers n) { return bullNoseCutter(n[0], n[1], n[2]); }},
      {"cone",
       {"radius", "angle", "length", "tip_radius"},
       [](Numbers n) { return coneCutter(n[0], n[1], n[2], n[3]); }},
      {"taper", {"radius", "angle", "tip_radius", "length"}, [](Numbers n) {
         return taperCutter(n[0], n[1], n[2], n[3]);
       }}};
  return kinds;
}

/// Refuses a number or ring of a cutter as its keys call it. The engine counts parts from the cutting end.
[[noreturn]] void refuseCutter(const JsonValue& value, const std::string& problem) {
  size_t part = 0, ring = 0;
  const int places = std::sscanf(problem.c_str(), "parts[%zu][%zu]", &part, &ring);
  const size_t end = problem.find(": ");
  const std::string key = problem.substr(0, end), rest = problem.substr(end + 2);
  if (places < 1) value.member(key.c_str()).refuse(rest);
  const JsonValue holder = value.member("holder"), own = holder[part - 1];
  (places == 1 ? own : own[ring]).refuse(rest);
}

/// {"shape": "flat", "radius": 3, "length": 50, "holder": [[[50, 15], [80, 20]]]}
FileMesh cutterFrom(const JsonValue& value, const CutterKind& kind) {
  const bool isCone = kind.name == std::string("cone");
  std::set<std::string> keys{"shape", "holder"};
  keys.insert(kind.numbers.begin(), kind.numbers.end());
  for (const auto& [key, unused] : value.json().items()) {
    if (!keys.contains(key)) value.refuse("\"" + key + "\": expected none in a " + kind.name);
  }
  std::vector<double> numbers;
  for (const char* key : kind.numbers) {
    const bool isMissing = isCone && key == std::string("tip_radius") && !value.has(key);
    numbers.push_back(isMissing ? 0 : value.member(key).number());
  }
  FileMesh mesh;
  mesh.name = kind.name;
  try {
    mesh.cutter = kind.make(numbers);
  } catch (const Error& error) {
    refuseCutter(value, problemOf(error));
  }
  value.ifHas("holder", [&](const JsonValue& holder) {
    for (size_t i = 0; i < holder.size(); ++i) {
      mesh.cutter.parts.emplace_back();
      const JsonValue part = holder[i];
      for (size_t k = 0; k < part.size(); ++k) {
        const JsonValue ring = part[k];
        if (ring.size() != 2 && ring.size() != 3) ring.expected("2 or 3 numbers: height, radius and corner");
        mesh.cutter.parts.back().push_back(
            {ring[0].number(), ring[1].number(), ring.size() == 3 ? ring[2].number() : 0});
      }
    }
  });
  try {
    Scene scene;
    const MeshView shown = scene.mesh(scene.addCutter(mesh.cutter));
    mesh.positions.assign(shown.positions.begin(), shown.positions.end());
    mesh.indices.assign(shown.indices.begin(), shown.indices.end());
  } catch (const Error& error) {
    refuseCutter(value, problemOf(error));
  }
  return mesh;
}

/// {"shape": "ball", "radius": 2}, {"shape": "capsule", "from": [0,0,0], "to": [0,0,3], "radius": 2}
FileMesh shapeFrom(const JsonValue& value) {
  const JsonValue kind = value.member("shape");
  const std::string name = kind.string();
  for (const CutterKind& cutter : cutterKinds()) {
    if (name == cutter.name) return cutterFrom(value, cutter);
  }
  if (name != "ball" && name != "capsule") {
    kind.expected("\"ball\", \"capsule\", \"flat\", \"ball_cutter\", \"bull_nose\", \"cone\" or \"taper\"");
  }
  std::vector<double> corners(3);
  if (name == "ball") {
    requireKnownKeys(value, {"shape", "radius"});
  } else {
    requireKnownKeys(value, {"shape", "from", "to", "radius"});
    corners.clear();
    for (const char* key : {"from", "to"}) {
      const JsonValue end = value.member(key);
      if (end.size() != 3) end.expected("3 numbers");
      for (size_t k = 0; k < 3; ++k) {
        corners.push_back(end[k].number());
        if (std::abs(corners.back()) > double{std::numeric_limits<float>::max()})
          end[k].expected("a number that floats hold");
      }
    }
  }
  const uint32_t last = static_cast<uint32_t>(corners.size() / 3) - 1;
  const std::vector<uint32_t> triangle{0, last, last};
  const FloatVertices floats = floatVertices(corners, triangle);
  FileMesh mesh{{.name = name, .positions = floats.positions, .indices = triangle}, floats.base};
  mesh.radius = radiusFrom(value.member("radius"));
  return mesh;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::vector<std::string>& warnings, const Outputs& outputs)
      : file_(file), name_(file == "-" ? "standard input" : file.string()), warnings_(warnings), outputs_(outputs) {}

  JsonQueryFile read();

 private:
  std::string content() const;
  std::filesystem::path pathOf(const JsonValue& value) const;
  /// `more`: a key that it may have beside its file and scale.
  MeshSource sourceOf(const JsonValue& value, std::string_view more = "scale") const;
  void readMesh(const JsonValue& value);
  FileMesh fileMeshFrom(const JsonValue& value);
  void readScene(const JsonValue& scene);
  void readInstances(const JsonValue& scene, SceneSpec& spec);
  const Assembly& assembly(const std::filesystem::path& file, double scale);
  void readQuery(const JsonValue& query);
  std::vector<Instance> readInstanceFile(const std::filesystem::path& file);
  std::vector<ObjectMask> readMasks(const JsonValue& list, size_t objects) const;
  std::vector<ObjectMotion> readMotions(const JsonValue& list, size_t objects) const;
  std::vector<Deformation> readDeforms(const JsonValue& list);
  std::vector<float> readPositions(const std::filesystem::path& file, uint32_t number);

  std::filesystem::path file_;
  std::string name_;
  std::vector<std::string>& warnings_;
  const Outputs& outputs_;
  Workload workload_;
  Fingerprint fingerprint_;                   ///< of what is read
  std::vector<std::array<double, 3>> bases_;  ///< of the meshes that the file lists; those of assemblies follow
  std::map<std::pair<std::filesystem::path, double>, Assembly> assemblies_;  ///< by file and scale
  std::map<const Assembly*, uint32_t> firstMesh_;                            ///< of the assemblies that scenes place
  std::unordered_set<std::string> sceneIds_, queryIds_;
};

std::string Reader::content() const {
  outputs_.requireNone(file_ == "-" ? "/dev/stdin" : file_);
  if (file_ == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  return readRegularFile(file_, "a query file, or - for standard input");
}

// A file that the query file names, or a node of one.
std::filesystem::path Reader::pathOf(const JsonValue& value) const {
  std::filesystem::path path = file_.parent_path() / value.string();
  outputs_.requireNone(splitMeshName(path).file);
  return path;
}

MeshSource Reader::sourceOf(const JsonValue& value, std::string_view more) const {
  if (value.json().is_string()) return {value.string(), pathOf(value)};
  if (!value.json().is_object()) value.expected("a string or an object");
  requireKnownKeys(value, {"file", "scale", more});
  MeshSource source{value.member("file").string(), pathOf(value.member("file"))};
  value.ifHas("scale", [&](const JsonValue& scale) { source.scale = scale.number(); });
  return source;
}

JsonQueryFile Reader::read() {
  const std::string text = content();
  fingerprint_.add(text);
  const nlohmann::json document = parseJson(name_, text);
  const JsonValue root(name_, document);
  requireKnownKeys(root, {"format", "meshes", "chains", "scenes", "queries", "queries_file"});
  const JsonValue format = root.member("format");
  if (format.string() != "cyber-radar-queries-1") format.expected("\"cyber-radar-queries-1\"");
  root.member("meshes").forEach([&](const JsonValue& mesh) { readMesh(mesh); });
  root.ifHas("chains", [&](const JsonValue& chains) {
    chains.forEach([&](const JsonValue& chain) { workload_.chains.push_back(chainFrom(chain, workload_, bases_)); });
  });
  root.member("scenes").forEach([&](const JsonValue& scene) { readScene(scene); });
  JsonQueryFile result;
  if (root.has("queries_file")) {
    const JsonValue name = root.member("queries_file");
    if (root.has("queries")) name.refuse("expected either \"queries\" or \"queries_file\", got both");
    result.queriesFile = pathOf(name);
  } else {
    root.member("queries").forEach([&](const JsonValue& query) { readQuery(query); });
  }
  // A mesh decides, whatever its file looks like.
  for (const MeshData& mesh : workload_.meshes) {
    fingerprint_.add(mesh.positions);
    fingerprint_.add(mesh.indices);
  }
  result.name = name_;
  result.workload = std::move(workload_);
  result.fingerprint = fingerprint_;
  result.bases = bases_;
  return result;
}

void Reader::readMesh(const JsonValue& value) {
  const FileMesh mesh = value.json().is_object() && value.has("shape") ? shapeFrom(value) : fileMeshFrom(value);
  workload_.meshes.push_back(mesh);
  bases_.push_back(mesh.base);
  fingerprint_.add(mesh.base);
}

FileMesh Reader::fileMeshFrom(const JsonValue& value) {
  const MeshSource source = sourceOf(value, "radius");
  FileMesh mesh = value.guard([&] {
    const MeshName split = splitMeshName(source.path);
    return split.node ? assembly(split.file, source.scale).meshOf(split.file.string(), *split.node)
                      : tools::readMesh(source.path, warnings_, source.scale);
  });
  mesh.name = source.name;
  if (value.json().is_object())
    value.ifHas("radius", [&](const JsonValue& radius) { mesh.radius = radiusFrom(radius); });
  return mesh;
}

const Assembly& Reader::assembly(const std::filesystem::path& file, double scale) {
  const std::pair key(file, scale);
  auto found = assemblies_.find(key);
  if (found == assemblies_.end()) found = assemblies_.emplace(key, readAssembly(file, warnings_, scale)).first;
  return found->second;
}

void Reader::readScene(const JsonValue& scene) {
  requireKnownKeys(scene, {"id", "base", "instances", "instances_file", "assembly", "masks", "motions", "deforms"});
  SceneSpec spec;
  scene.ifHas("id", [&](const JsonValue& id) {
    spec.id = id.string();
    if (!sceneIds_.insert(spec.id).second) id.expected("an id that no other scene has");
  });
  scene.ifHas("base", [&](const JsonValue& base) {
    spec.base = base.index(workload_.scenes.size(), "scenes before this one");
    if (workload_.scenes[*spec.base].base) base.expected("a scene that has no base itself");
  });
  readInstances(scene, spec);
  for (size_t i = 0; i < spec.instances.size(); ++i) {
    const uint32_t mesh = spec.instances[i].mesh;
    const std::string wrong = onlySensor(workload_.meshes[mesh]);
    if (!wrong.empty()) scene.refuse("instance " + std::to_string(i) + ": mesh " + std::to_string(mesh) + ": " + wrong);
  }
  const size_t objects = (spec.base ? workload_.scenes[*spec.base].instances.size() : 0) + spec.instances.size();
  scene.ifHas("masks", [&](const JsonValue& masks) { spec.masks = readMasks(masks, objects); });
  scene.ifHas("motions", [&](const JsonValue& motions) { spec.motions = readMotions(motions, objects); });
  scene.ifHas("deforms", [&](const JsonValue& deforms) { spec.deforms = readDeforms(deforms); });
  workload_.scenes.push_back(std::move(spec));
}

void Reader::readInstances(const JsonValue& scene, SceneSpec& spec) {
  if (scene.has("instances") + scene.has("instances_file") + scene.has("assembly") > 1) {
    scene.refuse("expected only one of \"instances\", \"instances_file\" and \"assembly\", got several");
  }
  if (scene.has("instances_file")) {
    const JsonValue file = scene.member("instances_file");
    const std::filesystem::path path = pathOf(file);
    spec.instances = file.guard([&] { return readInstanceFile(path); });
  } else if (scene.has("assembly")) {
    const JsonValue file = scene.member("assembly");
    const MeshSource source = sourceOf(file);
    const Assembly& parts = file.guard([&]() -> const Assembly& { return assembly(source.path, source.scale); });
    const auto [first, isNew] = firstMesh_.emplace(&parts, static_cast<uint32_t>(workload_.meshes.size()));
    if (isNew) workload_.meshes.insert(workload_.meshes.end(), parts.meshes.begin(), parts.meshes.end());
    for (const Assembly::Part& part : parts.parts) {
      const Transform fileFromMesh = aboutBase(part.fileFromNode, parts.meshes[part.mesh].base);
      spec.instances.push_back({first->second + part.mesh, fileFromMesh});
      spec.names.push_back(part.name);
      fingerprint_.add(part.name);
      fingerprint_.add(std::array{part.mesh});
      fingerprint_.add(fileFromMesh.m);
    }
  } else {
    scene.member("instances").forEach([&](const JsonValue& list) {
      spec.instances.push_back(instanceFrom(list, bases_));
    });
  }
}

std::vector<ObjectMask> Reader::readMasks(const JsonValue& list, size_t objects) const {
  std::vector<ObjectMask> masks;
  std::unordered_set<uint32_t> named;
  list.forEach([&](const JsonValue& pair) {
    if (pair.size() != 2) pair.expected("[object, bits]");
    masks.emplace_back(pair[0].index(objects, "objects"), pair[1].wholeNumber<uint32_t>());
    if (!named.insert(masks.back().first).second) pair[0].expected("each object once");
  });
  return masks;
}

std::vector<ObjectMotion> Reader::readMotions(const JsonValue& list, size_t objects) const {
  std::vector<ObjectMotion> motions;
  std::unordered_set<uint32_t> named;
  list.forEach([&](const JsonValue& entry) {
    if (entry.size() != 4) entry.expected("[object, dx, dy, dz]");
    motions.push_back({entry[0].index(objects, "objects"), motionFrom(entry, 1)});
    if (!named.insert(motions.back().first).second) entry[0].expected("each object once");
  });
  return motions;
}

std::vector<Deformation> Reader::readDeforms(const JsonValue& list) {
  std::vector<Deformation> deforms;
  std::unordered_set<uint32_t> named;
  list.forEach([&](const JsonValue& pair) {
    if (pair.size() != 2) pair.expected("[mesh, \"file of positions\"]");
    const uint32_t mesh = pair[0].index(bases_.size(), "meshes");
    if (!named.insert(mesh).second) pair[0].expected("each mesh once");
    const std::filesystem::path file = pathOf(pair[1]);
    deforms.push_back({mesh, pair[1].guard([&] { return readPositions(file, mesh); })});
  });
  return deforms;
}

std::vector<float> Reader::readPositions(const std::filesystem::path& file, uint32_t number) {
  const MeshData& mesh = workload_.meshes[number];
  static_assert(std::endian::native == std::endian::little);
  const std::string bytes = readRegularFile(file, "a file of vertex positions");
  fingerprint_.add(bytes);
  std::vector<float> positions(mesh.positions.size());
  const size_t expected = positions.size() * sizeof(float);
  if (bytes.size() != expected) {
    throw InputError(file.string(), "",
                     "expected " + std::to_string(expected) + " bytes, 3 floats for each of the " +
                         std::to_string(mesh.vertexCount()) + " vertices of " + mesh.name + ", got " +
                         std::to_string(bytes.size()));
  }
  std::memcpy(positions.data(), bytes.data(), expected);
  for (size_t i = 0; i < positions.size(); ++i) {
    if (std::isfinite(positions[i])) continue;
    throw InputError(file.string(), "vertex " + std::to_string(i / 3), "expected finite numbers");
  }
  for (size_t i = 0; i < positions.size(); ++i) {
    positions[i] = static_cast<float>(double(positions[i]) - bases_[number][i % 3]);
  }
  return positions;
}

std::vector<Instance> Reader::readInstanceFile(const std::filesystem::path& file) {
  const BinaryQueries rows(file, workload_, bases_, true);
  fingerprint_.add(rows.bytes());
  std::vector<Instance> instances;
  for (uint64_t i = 0; i < rows.count(); ++i) instances.push_back(rows.placed(i));
  return instances;
}

void Reader::readQuery(const JsonValue& query) {
  workload_.queries.push_back(queryFrom(query, workload_, bases_));
  const std::string& id = workload_.queries.back().id;
  if (!queryIds_.insert(id).second) query.member("id").expected("an id that no other query has");
}

}  // namespace

JsonQueryFile readJsonQueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                const Outputs& outputs) {
  return Reader(file, warnings, outputs).read();
}

}  // namespace radar::tools
