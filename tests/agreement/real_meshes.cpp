#include "agreement/real_meshes.h"

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

}  // namespace

tools::MeshFamilies realMeshes() {
  return {
      {"assimp", readAll(RADAR_ASSIMP_MODELS, {"OBJ/spider.obj", "OBJ/WusonOBJ.obj", "PLY/Wuson.ply", "PLY/cube.ply",
                                               "STL/sphereWithHole.stl", "STL/Spider_ascii.stl", "Collada/duck.dae",
                                               "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"})},
      {"cgal", readAll(RADAR_CGAL_MESHES, {"elephant.off", "elephant-with-holes.off", "knot1.off", "eight.off",
                                           "camel.off", "hand.off", "anchor.off", "pig.stl"})}};
}

}  // namespace radar::test
