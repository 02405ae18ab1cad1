#include <cstring>
#include <nlohmann/json.hpp>

#include "import/mesh_import.h"
#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar::tools;
using radar::test::Contains;
using radar::test::ScratchFolder;

namespace {

MeshData read(const std::string& file) {
  std::vector<std::string> warnings;
  MeshData mesh = readMesh(file, warnings);
  CHECK(warnings.empty());
  return mesh;
}

/// The corners of each triangle, so that importers that number vertices otherwise compare equal.
std::vector<float> corners(const MeshData& mesh) {
  std::vector<float> values;
  for (uint32_t index : mesh.indices) {
    for (int k = 0; k < 3; ++k) values.push_back(mesh.positions[3 * index + k]);
  }
  return values;
}

std::string ply(int vertices, int faces, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n" + rows;
}

std::string refusal(const std::string& file) {
  std::vector<std::string> warnings;
  try {
    readMesh(file, warnings);
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Contains(file) && Contains("expected"));
    return error.what();
  }
  FAIL("not refused: " << file);
  return {};
}

/// A glTF file of two meshes, of one triangle and of two. `nodes` are the nodes of a list; those that no other has as a
/// child are 0 and the last one.
std::string writeNodes(const ScratchFolder& folder, const std::string& nodes) {
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  folder.write("a.bin", std::string(reinterpret_cast<const char*>(positions), sizeof positions));
  const auto count = nlohmann::json::parse("[" + nodes + "]").size();
  const std::string roots = count == 1 ? "0" : "0, " + std::to_string(count - 1);
  return folder.write("a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [)" + roots +
                                    R"(]}], "nodes": [)" + nodes + R"(],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]},
               {"primitives": [{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"uri": "a.bin", "byteLength": 36}]})");
}

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("faces of more than three corners become a fan from their first corner, concave ones too") {
  const ScratchFolder folder;
  const MeshData mesh = read(folder.write("a.obj", std::string(kSquare) + "v 0.1 0.1 0\nf 2 3 4 5 1\n"));
  CHECK(corners(mesh) ==
        std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, .1f, .1f, 0, 1, 0, 0, .1f, .1f, 0, 0, 0, 0});
}

TEST_CASE("duplicate vertices are not merged, and degenerate faces stay in place") {
  const ScratchFolder folder;
  const MeshData mesh =
      read(folder.write("a.ply", ply(5, 3, "0 0 0\n1 0 0\n0 1 0\n0 0 0\n9 9 9\n3 0 1 2\n3 0 0 0\n3 3 1 3\n")));
  CHECK(mesh.vertexCount() == 5);
  CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 0, 0, 0, 3, 1, 3});
}

TEST_CASE("lines are dropped with a warning that counts them") {
  const ScratchFolder folder;
  const std::string file = folder.write("a.obj", std::string(kSquare) + "f 1 2 3\nl 1 2\nl 2 3\n");
  std::vector<std::string> warnings;
  CHECK(readMesh(file, warnings).triangleCount() == 1);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains(file) && Contains("2 lines"));
}

TEST_CASE("nodes are visited depth-first, their transforms are multiplied, and each use of a mesh is a copy") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"mesh": 0, "translation": [10, 0, 0], "children": [1, 2]},
    {"mesh": 0, "scale": [2, 3, 4]}, {"mesh": 0, "translation": [0, 0, 7]}, {"mesh": 0})");
  CHECK(corners(read(file)) == std::vector<float>{10, 0, 0, 11, 0, 0, 10, 1, 0,  //
                                                  10, 0, 0, 12, 0, 0, 10, 3, 0,  //
                                                  10, 0, 7, 11, 0, 7, 10, 1, 7,  //
                                                  0,  0, 0, 1,  0, 0, 0,  1, 0});
}

TEST_CASE("an assembly has a part per node with triangles, named and placed by it, and nodes share a mesh") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"name": "frame", "translation": [10, 0, 0], "children": [1, 2]},
    {"name": "lid", "mesh": 0, "scale": [2, 3, 4]}, {"name": "lid", "mesh": 0, "translation": [0, 0, 7]},
    {"name": "3", "mesh": 1})");
  std::vector<std::string> warnings;
  const Assembly assembly = readAssembly(file, warnings);
  CHECK(warnings.empty());
  REQUIRE(assembly.parts.size() == 3);
  REQUIRE(assembly.meshes.size() == 2);
  CHECK((assembly.parts[0].name == "lid" && assembly.parts[1].name == "lid" && assembly.parts[2].name == "3"));
  CHECK((assembly.parts[0].mesh == 0 && assembly.parts[1].mesh == 0 && assembly.parts[2].mesh == 1));
  CHECK(assembly.parts[0].fileFromMesh.m == std::array<double, 12>{2, 0, 0, 10, 0, 3, 0, 0, 0, 0, 4, 0});
  CHECK(assembly.parts[1].fileFromMesh.m == std::array<double, 12>{1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 7});
  CHECK(corners(assembly.meshes[0]) == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});

  CHECK(corners(read(file + "#1")) == corners(assembly.meshes[0]));
  CHECK(read(file + "#2").triangleCount() == 2);
  CHECK_THAT(refusal(file + "#3"), Contains("expected one of the 3 nodes, from 0"));
  CHECK_THAT(refusal(file + "#"), Contains("#: expected one of the 3 nodes"));
  CHECK_THAT(refusal(file + "#99999999999"), Contains("one of the 3 nodes"));
  CHECK_THAT(refusal(file + "#lid"), Contains("that 2 have"));
  CHECK_THAT(refusal(file + "#frame"), Contains("that none has"));
}

TEST_CASE("a node may be named by what it alone is called, and a # in the name of a file is part of it") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"name": "a#b", "mesh": 1}, {"name": "in/out", "mesh": 0})");
  CHECK(read(file + "#a#b").triangleCount() == 2);
  CHECK(read(file + "#in/out").triangleCount() == 1);
  const std::string odd = folder.write("odd#0.obj", std::string(kSquare) + "f 1 2 3 4\n");
  CHECK(read(odd).triangleCount() == 2);
  CHECK(read(odd + "#0").triangleCount() == 2);
}

TEST_CASE("an assembly with a node that flattens its mesh is refused") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"name": "flat", "mesh": 0, "scale": [1, 0, 1]})");
  std::vector<std::string> warnings;
  CHECK_THROWS_WITH(readAssembly(file, warnings), Contains("node \"flat\": expected an invertible matrix"));
}

TEST_CASE("the message about a broken mesh file names the file, the place and what was expected") {
  const ScratchFolder folder;
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n", off = "OFF\n3 1 0\n";
  const std::string square = kSquare;
  CHECK_THAT(refusal((folder.path() / "missing.obj").string()), Contains("no such file"));
  CHECK_THAT(refusal(folder.path().string()), Contains("folder"));
  CHECK_THAT(refusal(folder.write("empty.ply", "")), Contains("empty"));
  CHECK_THAT(refusal(folder.write("text.xyz", "no mesh at all")), Contains("assimp"));
  CHECK_THAT(refusal(folder.write("none.obj", square)), Contains("at least one triangle"));
  CHECK_THAT(refusal(folder.write("line.obj", square + "l 1 2\n")), Contains("1 line"));
  CHECK_THAT(refusal(folder.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), Contains("vertex 0"));
  CHECK_THAT(refusal(folder.write("inf.ply", ply(3, 1, "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n"))), Contains("vertex 1"));
  // A number that is too large is named as it is written.
  const std::string large = "0 0 0\n1 0 0\n0 1e39 0\n3 0 1 2\n", words = " in the range of floats, got ";
  CHECK_THAT(refusal(folder.write("large.off", off + large)),
             Contains("line 5: expected a number" + words + "\"1e39\""));
  CHECK_THAT(refusal(folder.write("large.ply", ply(3, 1, large))),
             Contains("vertex 2: expected a coordinate" + words + "\"1e39\""));
  CHECK_THAT(refusal(folder.write("large.obj", "v 0 0 -1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
             Contains("line 1: expected a number" + words + "\"-1e39\""));
  CHECK_THAT(refusal(folder.write("large.stl", "solid a\nfacet\nouter loop\nvertex 0 1e39 0\n")),
             Contains("line 4: expected a number" + words + "\"1e39\""));
  CHECK_THAT(refusal(folder.write("index.obj", square + "f 1 2 9\n")),
             Contains("line 5: expected one of the file's 4"));
  CHECK_THAT(refusal(folder.write("index.ply", ply(3, 1, three + "3 0 1 3\n"))), Contains("face 0"));
  CHECK_THAT(refusal(folder.write("index.off", off + three + "3 0 1 3\n")), Contains("line 6") && Contains("face 0"));
  CHECK_THAT(refusal(folder.write("sign.off", off + three + "3 0 1 -1\n")), Contains("\"-1\""));
  CHECK_THAT(refusal(folder.write("cut.ply", ply(3, 2, three + "3 0 1 2\n"))), Contains("element face"));
  CHECK_THAT(refusal(folder.write("cut2.ply", ply(4, 1, three))), Contains("element vertex"));
  CHECK_THAT(refusal(folder.write("cut3.ply", "ply\nformat ascii 1.0\n")), Contains("header"));
  CHECK_THAT(refusal(folder.write("cut.off", "OFF\n3 2 0\n" + three + "3 0 1 2\n")), Contains("face 1"));
  CHECK_THAT(refusal(folder.write("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n")),
             Contains("line 5: expected endfacet"));
}

TEST_CASE("an STL file is binary or text by what it holds, whatever its first word or the case of its name") {
  const ScratchFolder folder;
  std::string binary = "solid of an exporter";
  binary.resize(80, ' ');
  binary += std::string("\1\0\0\0", 4) + std::string(12, '\0');
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  binary.append(reinterpret_cast<const char*>(corners), sizeof corners).append(2, '\0');
  CHECK(read(folder.write("PART.STL", binary)).triangleCount() == 1);
  const std::string expected = "expected 134 bytes, as its 1 facets take in a binary file, got ";
  CHECK_THAT(refusal(folder.write("long.stl", binary + "?")), Contains("long.stl: " + expected + "135"));
  CHECK_THAT(refusal(folder.write("cut.stl", binary.substr(0, 100))), Contains("cut.stl: " + expected + "100"));
  const std::string capitals =
      "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID "
      "A\n";
  CHECK(read(folder.write("capitals.stl", capitals)).triangleCount() == 1);
}

TEST_CASE("quarter turns in a glTF file are exact, though floats cannot hold their quaternions") {
  const ScratchFolder folder;
  // What decimals and floats make of it, two in a row, and one scaled; a matrix and places are doubles, too.
  const std::string file = writeNodes(folder, R"(
    {"rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "translation": [0.1, 0, 0], "children": [1, 2]},
    {"mesh": 0, "rotation": [0.70710677, 0, 0, -0.70710677], "translation": [0.3, 0, 0]},
    {"mesh": 0, "rotation": [0, 0.7071, 0, 0.7071], "scale": [2, 3, 4]},
    {"mesh": 0, "matrix": [0.1, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 0.3, 0, 1, 2, 0.7, 1]})");
  std::vector<std::string> warnings;
  const Assembly assembly = readAssembly(file, warnings);
  REQUIRE(assembly.parts.size() == 3);
  CHECK(assembly.parts[0].fileFromMesh.m == std::array<double, 12>{0, 0, -1, 0.1, 1, 0, 0, 0.3, 0, -1, 0, 0});
  CHECK(assembly.parts[1].fileFromMesh.m == std::array<double, 12>{0, -3, 0, 0.1, 0, 0, 4, 0, -2, 0, 0, 0});
  CHECK(assembly.parts[2].fileFromMesh.m == std::array<double, 12>{0.1, 0, 0, 1, 0, 0.2, 0, 2, 0, 0, 0.3, 0.7});
}

TEST_CASE("a binary PLY file that ends early is refused") {
  const ScratchFolder folder;
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string body(reinterpret_cast<const char*>(positions), sizeof positions);
  for (char byte : {3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}) body += byte;
  std::string content = ply(3, 1, body);
  content.replace(content.find("ascii"), 5, "binary_little_endian");
  CHECK(read(folder.write("whole.ply", content)).triangleCount() == 1);
  for (size_t cut : {1u, 5u, 13u, 14u, 40u}) {
    CAPTURE(cut);
    refusal(folder.write("cut.ply", content.substr(0, content.size() - cut)));
  }
}

TEST_CASE("files of many formats are read") {
  const std::string models = "/usr/share/assimp/models/";
  for (const auto& [name, triangles] :
       {std::pair{"OBJ/spider.obj", 1368u}, std::pair{"PLY/Wuson.ply", 3732u}, std::pair{"PLY/cube_binary.ply", 12u},
        std::pair{"OFF/Wuson.off", 3732u}, std::pair{"STL/Spider_binary.stl", 1368u},
        std::pair{"STL/Spider_ascii.stl", 1368u}, std::pair{"glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 12u},
        std::pair{"Collada/duck.dae", 4212u}, std::pair{"3DS/cubes_with_alpha.3DS", 60u},
        std::pair{"FBX/box.fbx", 12u}}) {
    CAPTURE(name);
    std::vector<std::string> warnings;
    CHECK(readMesh(models + name, warnings).triangleCount() == triangles);
  }
}
