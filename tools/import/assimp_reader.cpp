#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <map>
#include <new>

#include "import/readers.h"

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

/// Files may name others: a device or a pipe among them would be read for ever.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }
};

bool tellsOfBrokenGeometry(const std::string& logLine) {
  for (const char* words : {"out of range", "out-of-range", "out of bounds", "nvalid vertex", "nvalid index",
                            "nvalid face", "faces were dropped", "Unexpected EOF"}) {
    if (logLine.find(words) != std::string::npos) return true;
  }
  return false;
}

Transform transformFrom(const aiMatrix4x4& matrix) {
  Transform transform;
  for (unsigned i = 0; i < 12; ++i) transform.m[i] = double(matrix[i / 4][i % 4]);
  return transform;
}

MeshFile::Part partFrom(const aiMesh& mesh) {
  MeshFile::Part part;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& vertex = mesh.mVertices[i];
    part.positions.insert(part.positions.end(), {vertex.x, vertex.y, vertex.z});
  }
  std::vector<uint32_t> corners;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    corners.assign(face.mIndices, face.mIndices + face.mNumIndices);
    part.addFace(corners);
  }
  return part;
}

MeshFile meshFileFrom(const aiScene& scene) {
  MeshFile file;
  std::map<unsigned, uint32_t> parts;  // assimp's mesh -> part
  struct Entry {
    const aiNode* node;
    Transform fileFromParent;
  };
  // No recursion: a file may nest its nodes as deeply as it likes.
  std::vector<Entry> open{{scene.mRootNode, {}}};
  while (!open.empty()) {
    const auto [node, fileFromParent] = open.back();
    open.pop_back();
    const Transform fileFromNode = product(fileFromParent, transformFrom(node->mTransformation));
    for (unsigned i = node->mNumChildren; i > 0; --i) {
      open.push_back({node->mChildren[i - 1], fileFromNode});
    }
    if (node->mNumMeshes == 0) continue;
    MeshFile::Node& to = file.nodes.emplace_back();
    to.name = node->mName.C_Str();
    to.fileFromNode = fileFromNode;
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const auto [known, isNew] = parts.emplace(node->mMeshes[i], static_cast<uint32_t>(file.parts.size()));
      if (isNew) file.parts.push_back(partFrom(*scene.mMeshes[known->first]));
      to.parts.push_back(known->second);
    }
  }
  return file;
}

}  // namespace

MeshFile readWithAssimp(const std::filesystem::path& file) {
  const std::string name = file.string();
  Assimp::Importer importer;
  importer.SetIOHandler(new RegularFiles);  // the importer deletes it
  // Without this, assimp invents a mesh for a file that holds only bones.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  std::vector<std::string> logLines;
  const aiScene* scene = nullptr;
  {
    ImportLog log(logLines);
    scene = importer.ReadFile(name, 0);
  }
  if (!scene && std::string_view(importer.GetErrorString()) == std::bad_alloc().what()) throw std::bad_alloc();
  if (!scene || !scene->mRootNode) {
    throw InputError(name, "",
                     "expected a mesh file that assimp reads, got: " + printable(importer.GetErrorString(), 200));
  }
  for (const std::string& line : logLines) {
    if (tellsOfBrokenGeometry(line))
      throw InputError(name, "", "expected an intact mesh file, got: " + printable(line, 200));
  }
  // A Collada file's root has no transform of its own: assimp's turns it upright and scales it to metres.
  const aiImporterDesc* const format =
      importer.GetImporterInfo(static_cast<size_t>(importer.GetPropertyInteger("importerIndex", -1)));
  if (format != nullptr && std::string_view(format->mName) == "Collada Importer") {
    scene->mRootNode->mTransformation = aiMatrix4x4();
  }
  return meshFileFrom(*scene);
}

}  // namespace radar::tools
