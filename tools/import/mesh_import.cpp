#include "import/mesh_import.h"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
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

struct Collector {
  const std::string file;
  const aiScene& scene;
  MeshData mesh;
  uint64_t points = 0, lines = 0;

  void add(const aiNode& node, const Transform& fileFromParent);
  void add(const aiMesh& part, const Transform& fileFromPart, const std::string& place);
};

void Collector::add(const aiNode& node, const Transform& fileFromParent) {
  const Transform fileFromNode = product(fileFromParent, node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const unsigned number = node.mMeshes[i];
    const std::string place = "node \"" + std::string(node.mName.C_Str()) + "\": mesh " + std::to_string(number);
    add(*scene.mMeshes[number], fileFromNode, place);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], fileFromNode);
}

void Collector::add(const aiMesh& part, const Transform& fileFromPart, const std::string& place) {
  const size_t first = mesh.vertexCount();
  if (first + part.mNumVertices > std::numeric_limits<uint32_t>::max() / 3) {
    throw InputError(file, place, "expected at most 2^32 / 3 vertices, got more");
  }
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& vertex = part.mVertices[i];
    for (const double coordinate : transformPoint(fileFromPart, &vertex.x)) {
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

}  // namespace

MeshData readMesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string name = file.string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(name, "",
                     std::string("expected a mesh file, got ") +
                         (std::filesystem::exists(file, error) ? "a folder" : "no such file"));
  }

  requireIntact(file);

  Assimp::Importer importer;
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
  Collector collector{name, *scene, {file.filename().string(), {}, {}}};
  collector.add(*scene->mRootNode, {});
  if (collector.mesh.indices.empty()) {
    throw InputError(name, "",
                     "expected at least one triangle, got " + plural(collector.points, "point") + " and " +
                         plural(collector.lines, "line"));
  }
  if (collector.points + collector.lines > 0) {
    warnings.push_back(name + ": dropped " + plural(collector.points, "point") + " and " +
                       plural(collector.lines, "line") + ", which are no surface");
  }
  return std::move(collector.mesh);
}

}  // namespace radar::tools
