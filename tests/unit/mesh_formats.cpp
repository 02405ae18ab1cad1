// Our readers of OBJ, STL, PLY and OFF number what a file holds as assimp does, so that answers name the same
// triangles.
#include <cmath>
#include <fstream>

#include "import/readers.h"
#include "import/regular_file.h"
#include "mesh_texts.h"
#include "workloads/random.h"

using namespace radar::tools;
using radar::test::ScratchFolder;

namespace {

MeshFile readOwn(const std::string& file) {
  const std::string content = readRegularFile(file, "a mesh file");
  const std::string extension = std::filesystem::path(file).extension();
  const Text text(file, content);
  if (extension == ".obj") return readObj(text);
  if (extension == ".stl" || extension == ".STL") return readStl(text);
  return extension == ".ply" ? readPly(text) : readOff(text);
}

/// Nodes and their parts, without those that hold nothing.
MeshFile pruned(const MeshFile& file) {
  MeshFile result;
  for (const MeshFile::Node& node : file.nodes) {
    MeshFile::Node kept{node.name, node.fileFromNode, {}};
    for (uint32_t number : node.parts) {
      const MeshFile::Part& part = file.parts[number];
      if (part.indices.empty() && part.points + part.lines == 0) continue;
      kept.parts.push_back(static_cast<uint32_t>(result.parts.size()));
      result.parts.push_back(part);
    }
    if (!kept.parts.empty()) result.nodes.push_back(kept);
  }
  return result;
}

/// Assimp rounds a coordinate by a few units in the last place of its digits before and behind the point.
bool areNear(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > 1e-6 * (std::abs(a[i]) + 1e-30)) return false;
  }
  return true;
}

void requireSame(const std::string& name) {
  CAPTURE(name);
  const MeshFile ours = pruned(readOwn(name)), theirs = pruned(readWithAssimp(name));
  REQUIRE(ours.nodes.size() == theirs.nodes.size());
  REQUIRE(ours.parts.size() == theirs.parts.size());
  for (size_t i = 0; i < ours.nodes.size(); ++i) {
    CHECK(ours.nodes[i].name == theirs.nodes[i].name);
    CHECK(ours.nodes[i].parts == theirs.nodes[i].parts);
    CHECK(ours.nodes[i].fileFromNode == theirs.nodes[i].fileFromNode);
  }
  for (size_t i = 0; i < ours.parts.size(); ++i) {
    CHECK(ours.parts[i].indices == theirs.parts[i].indices);
    CHECK(ours.parts[i].points == theirs.parts[i].points);
    CHECK(ours.parts[i].lines == theirs.parts[i].lines);
    CHECK(areNear(ours.parts[i].positions, theirs.parts[i].positions));
  }
}

/// Statements of an OBJ file at random: objects and groups that come again, materials, points, lines, faces that name
/// vertices from either end or vertices that come later.
std::string anyObj(Random& random) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  uint32_t vertices = 4;
  const auto corner = [&] {
    const uint32_t number = 1 + random.below(vertices);
    std::string word = random.oneIn(3) ? "-" + std::to_string(number) : std::to_string(number);
    if (random.oneIn(4)) word += "/1/1";
    return " " + word;
  };
  for (uint32_t count = 10 + random.below(40); count > 0; --count) {
    const std::string name(1, "abc"[random.below(3)]);
    switch (random.below(9)) {
      case 0:
        text += "v " + std::to_string(random.below(9)) + " 1.5 -2e-1" + (random.oneIn(2) ? " 0.5 0.5 0.5\n" : "\n");
        ++vertices;
        break;
      case 1:
        text += "o " + name + "\n";
        break;
      case 2:
        text += "g " + name + (random.oneIn(2) ? " more\n" : "\n");
        break;
      case 3:
        text += "usemtl " + name + "\n";
        break;
      case 4:
        text += "l" + corner() + corner() + (random.oneIn(2) ? corner() : "") + "\n";
        break;
      case 5:
        text += "p" + corner() + "\n";
        break;
      default:
        text += "f" + corner() + corner() + corner();
        for (uint32_t more = random.below(3); more > 0; --more) text += corner();
        text += random.oneIn(4) ? " \\\n" + corner() + "\n" : "\n";
    }
  }
  return text + "f " + std::to_string(vertices + 1) + " 1 2\nv 7 7 7\n";
}

}  // namespace

TEST_CASE("the nodes, vertices and triangles of real OBJ, STL, PLY and OFF files are those that assimp reads") {
  const std::string models = RADAR_ASSIMP_MODELS "/", cgal = RADAR_CGAL_MESHES "/";
  for (const char* name : {"OBJ/WusonOBJ.obj",
                           "OBJ/box.obj",
                           "OBJ/box_longline.obj",
                           "OBJ/box_mat_with_spaces.obj",
                           "OBJ/concave_polygon.obj",
                           "OBJ/cube_mtllib_after_g.obj",
                           "OBJ/cube_usemtl.obj",
                           "OBJ/cube_with_vertexcolors.obj",
                           "OBJ/empty_mat.obj",
                           "OBJ/multiple_spaces.obj",
                           "OBJ/regr01.obj",
                           "OBJ/regr_3429812.obj",
                           "OBJ/space_in_material_name.obj",
                           "OBJ/spider.obj",
                           "OBJ/testline.obj",
                           "OBJ/testmixed.obj",
                           "OBJ/testpoints.obj",
                           "PLY/Wuson.ply",
                           "PLY/cube.ply",
                           "PLY/cube_binary.ply",
                           "PLY/cube_uv.ply",
                           "PLY/float-color.ply",
                           "STL/3DSMaxExport.STL",
                           "STL/Spider_ascii.stl",
                           "STL/Spider_binary.stl",
                           "STL/Wuson.stl",
                           "STL/sphereWithHole.stl",
                           "STL/triangle.stl",
                           "STL/triangle_with_empty_solid.stl",
                           "STL/triangle_with_two_solids.stl",
                           "OFF/Cube.off",
                           "OFF/Wuson.off"}) {
    requireSame(models + name);
  }
  for (const char* name : {"sphere.ply", "colored_tetra.ply", "elephant.off", "cube_quad.off", "bear.off"}) {
    requireSame(cgal + name);
  }
}

TEST_CASE("objects, groups and materials of OBJ files order their triangles as assimp does") {
  const ScratchFolder folder;
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const std::string text = anyObj(random);
    CAPTURE(text);
    requireSame(folder.write("a.obj", text));
  }
}

TEST_CASE("an OFF file may have comments anywhere and faces of any number of corners") {
  const ScratchFolder folder;
  std::string text = "# a disc\nOFF # its kind\n12 1 0 # counts\n";
  std::string face = "12";
  for (int i = 0; i < 12; ++i) {
    text += std::to_string(i) + " 0 1 # vertex\n# and\n\n";
    face += " " + std::to_string(i);
  }
  const MeshData mesh = radar::test::readWhole(folder.write("a.off", text + face + " 0.5 0.5 0.5\n"));
  CHECK(mesh.vertexCount() == 12);
  REQUIRE(mesh.triangleCount() == 10);
  CHECK(std::vector(mesh.indices.end() - 3, mesh.indices.end()) == std::vector<uint32_t>{0, 10, 11});
}
