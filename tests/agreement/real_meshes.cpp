#include "agreement/real_meshes.h"

#include <cstdlib>
#include <string>

#include "import/mesh_import.h"

namespace radar::test {

namespace {

std::vector<tools::MeshData> readAll(const std::string& folder, std::initializer_list<const char*> files) {
  std::vector<tools::MeshData> meshes;
  for (const char* file : files) {
    std::vector<std::string> warnings;
    meshes.push_back(tools::readMesh(folder + "/" + file, warnings));
  }
  return meshes;
}

// A folder of the build, or of the same meshes elsewhere.
std::string folderOf(const char* built, const char* name) {
  const char* elsewhere = std::getenv("RADAR_TEST_MESHES");
  return elsewhere == nullptr ? built : std::string(elsewhere) + "/" + name;
}

std::string assimpModels() {
  return folderOf(RADAR_ASSIMP_MODELS, "assimp");
}

}  // namespace

std::string engineFile() {
  return assimpModels() + "/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";
}

tools::MeshFamilies realMeshes() {
  return {{"assimp", readAll(assimpModels(), {"OBJ/spider.obj", "OBJ/WusonOBJ.obj", "PLY/Wuson.ply", "PLY/cube.ply",
                                              "STL/sphereWithHole.stl", "STL/Spider_ascii.stl", "Collada/duck.dae",
                                              "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"})},
          {"cgal", readAll(folderOf(RADAR_CGAL_MESHES, "cgal"),
                           {"elephant.off", "elephant-with-holes.off", "knot1.off", "eight.off", "camel.off",
                            "hand.off", "anchor.off", "pig.stl"})}};
}

}  // namespace radar::test
