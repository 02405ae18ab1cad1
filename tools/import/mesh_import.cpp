#include "import/mesh_import.h"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "import/mesh_file_validation.h"

namespace radar::tools {

namespace {

/// Assimp repairs some broken files, such as those with an index out of range, and says so only in its log. Most lines
/// of the log are about materials.
class ImportLog : public Assimp::LogStream {
 public:
  explicit ImportLog(std::vector<std::string>& lines) : lines_(lines) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(this, Assimp::Logger::Err | Assimp::Logger::Warn);
  }
  ~ImportLog() override {
    Assimp::DefaultLogger::get()->detachStream(this, Assimp::Logger::Err | Assimp::Logger::Warn);
    Assimp::DefaultLogger::kill();
  }
  void write(const char* message) override {
    std::string line = message;
    while (!line.empty() && line.back() == '\n') line.pop_back();
    lines_.push_back(line);
  }

 private:
  std::vector<std::string>& lines_;
};

bool tellsOfBrokenGeometry(const std::string& logLine) {
  for (const char* words : {"out of range", "out-of-range", "out of bounds", "nvalid vertex", "nvalid index",
                            "nvalid face", "faces were dropped", "Unexpected EOF"}) {
    if (logLine.find(words) != std::string::npos) return true;
  }
  return false;
}

Transform product(const Transform& a, const aiMatrix4x4& b) {
  Transform result;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      double sum = column == 3 ? a.m[4 * row + 3] : 0.0;
      for (unsigned k = 0; k < 3; ++k) sum += a.m[4 * row + k] * double(b[k][column]);
      result.m[4 * row + column] = sum;
    }
  }
  return result;
}

/// The triangles of parts of a file, as one mesh.
struct Collector {
  const std::string& file;
  const aiScene& scene;
  MeshData mesh;
  uint64_t points = 0, lines = 0;

  void add(const aiNode& node, const Transform& meshFromNode);
  void add(const aiMesh& part, const Transform& meshFromPart, const std::string& place);
};

std::string placeOf(const aiNode& node) {
  return "node \"" + std::string(node.mName.C_Str()) + "\"";
}

void Collector::add(const aiNode& node, const Transform& meshFromNode) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const unsigned number = node.mMeshes[i];
    add(*scene.mMeshes[number], meshFromNode, placeOf(node) + ": mesh " + std::to_string(number));
  }
}

void Collector::add(const aiMesh& part, const Transform& meshFromPart, const std::string& place) {
  const size_t first = mesh.vertexCount();
  if (first + part.mNumVertices > std::numeric_limits<uint32_t>::max() / 3) {
    throw InputError(file, place, "expected at most 2^32 / 3 vertices, got more");
  }
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& vertex = part.mVertices[i];
    for (const double coordinate : transformPoint(meshFromPart, &vertex.x)) {
      const float value = static_cast<float>(coordinate);
      if (!std::isfinite(value)) {
        std::ostringstream problem;
        problem << "expected 3 finite numbers, got " << vertex.x << " " << vertex.y << " " << vertex.z
                << " before the node's transform";
        throw InputError(file, place + ": vertex " + std::to_string(i), problem.str());
      }
      mesh.positions.push_back(value);
    }
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= part.mNumVertices) {
        throw InputError(file, place + ": face " + std::to_string(i),
                         "expected vertex numbers below " + std::to_string(part.mNumVertices) + ", got " +
                             std::to_string(face.mIndices[k]));
      }
    }
    if (face.mNumIndices == 1) ++points;
    if (face.mNumIndices == 2) ++lines;
    for (unsigned k = 2; k < face.mNumIndices; ++k) {
      for (unsigned corner : {0u, k - 1, k})
        mesh.indices.push_back(static_cast<uint32_t>(first + face.mIndices[corner]));
    }
  }
}

std::string plural(uint64_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void warnOfDropped(const Collector& collected, std::vector<std::string>& warnings) {
  if (collected.points + collected.lines == 0) return;
  warnings.push_back(collected.file + ": dropped " + plural(collected.points, "point") + " and " +
                     plural(collected.lines, "line") + ", which are no surface");
}

void requireTriangles(bool some, const Collector& collected) {
  if (some) return;
  throw InputError(collected.file, "",
                   "expected at least one triangle, got " + plural(collected.points, "point") + " and " +
                       plural(collected.lines, "line"));
}

/// Calls `use` with each node and its pose, depth-first.
template <class Use>
void forEachNode(const aiNode& node, const Transform& fileFromParent, const Use& use) {
  const Transform fileFromNode = product(fileFromParent, node.mTransformation);
  use(node, fileFromNode);
  for (unsigned i = 0; i < node.mNumChildren; ++i) forEachNode(*node.mChildren[i], fileFromNode, use);
}

const aiScene& openFile(Assimp::Importer& importer, const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(name, "",
                     std::string("expected a mesh file, got ") +
                         (std::filesystem::exists(file, error) ? "a folder" : "no such file"));
  }
  requireIntact(file);
  // Without this, assimp invents a mesh for a file that holds only bones.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  std::vector<std::string> logLines;
  const aiScene* scene = nullptr;
  {
    ImportLog log(logLines);
    scene = importer.ReadFile(name, 0);
  }
  if (!scene || !scene->mRootNode) {
    throw InputError(name, "",
                     "expected a mesh file that assimp reads, got: " + std::string(importer.GetErrorString()));
  }
  for (const std::string& line : logLines) {
    if (tellsOfBrokenGeometry(line)) throw InputError(name, "", "expected an intact mesh file, got: " + line);
  }
  return *scene;
}

MeshData readWholeFile(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  Assimp::Importer importer;
  const aiScene& scene = openFile(importer, file);
  const std::string name = file.string();
  Collector collector{name, scene, {file.filename().string(), {}, {}}};
  forEachNode(*scene.mRootNode, {},
              [&](const aiNode& node, const Transform& fileFromNode) { collector.add(node, fileFromNode); });
  requireTriangles(!collector.mesh.indices.empty(), collector);
  warnOfDropped(collector, warnings);
  return std::move(collector.mesh);
}

}  // namespace

Assembly readAssembly(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  Assimp::Importer importer;
  const aiScene& scene = openFile(importer, file);
  const std::string name = file.string();
  Assembly assembly;
  Collector collector{name, scene, {}};
  std::map<std::vector<unsigned>, uint32_t> known;  // what nodes list -> its mesh
  forEachNode(*scene.mRootNode, {}, [&](const aiNode& node, const Transform& fileFromNode) {
    const std::vector<unsigned> listed(node.mMeshes, node.mMeshes + node.mNumMeshes);
    auto found = known.find(listed);
    if (found == known.end()) {
      collector.mesh = {file.filename().string() + "#" + std::to_string(assembly.parts.size()), {}, {}};
      collector.add(node, {});
      if (collector.mesh.indices.empty()) return;
      found = known.emplace(listed, static_cast<uint32_t>(assembly.meshes.size())).first;
      assembly.meshes.push_back(std::move(collector.mesh));
    }
    if (std::string wrong = validate(fileFromNode); !wrong.empty()) throw InputError(name, placeOf(node), wrong);
    assembly.parts.push_back({node.mName.C_Str(), found->second, fileFromNode});
  });
  requireTriangles(!assembly.parts.empty(), collector);
  warnOfDropped(collector, warnings);
  return assembly;
}

const MeshData& Assembly::meshOf(const std::string& file, const std::string& node) const {
  if (node.find_first_not_of("0123456789") == node.npos) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(node.data(), node.data() + node.size(), number);
    if (node.empty() || error != std::errc() || number >= parts.size()) {
      throw InputError(file + "#" + node, "", "expected one of the " + plural(parts.size(), "node") + ", from 0");
    }
    return meshes[parts[number].mesh];
  }
  const Part* found = nullptr;
  size_t count = 0;
  for (const Part& part : parts) {
    if (part.name != node) continue;
    found = &part;
    ++count;
  }
  if (count != 1) {
    throw InputError(file + "#" + node, "",
                     "expected the name that one node with triangles has, or a node's number, got a name that " +
                         (count == 0 ? "none has" : std::to_string(count) + " have"));
  }
  return meshes[found->mesh];
}

MeshName splitMeshName(const std::filesystem::path& name) {
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error)) return {name, {}};
  const std::string text = name.string();
  for (size_t at = text.find('#'); at != text.npos; at = text.find('#', at + 1)) {
    if (std::filesystem::is_regular_file(text.substr(0, at), error)) return {text.substr(0, at), text.substr(at + 1)};
  }
  return {name, {}};
}

MeshData readMesh(const std::filesystem::path& name, std::vector<std::string>& warnings) {
  const MeshName split = splitMeshName(name);
  if (!split.node) return readWholeFile(split.file, warnings);
  MeshData mesh = readAssembly(split.file, warnings).meshOf(split.file.string(), *split.node);
  mesh.name = name.filename().string();
  return mesh;
}

}  // namespace radar::tools
