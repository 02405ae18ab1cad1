// What becomes of mesh files: nodes, faces and messages.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "mesh_texts.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

/// The corners of each triangle, so that importers that number vertices otherwise compare equal.
std::vector<float> corners(const MeshData& mesh) {
  std::vector<float> values;
  for (uint32_t index : mesh.indices) {
    for (int k = 0; k < 3; ++k) values.push_back(mesh.positions[3 * index + k]);
  }
  return values;
}

/// A glTF file of those nodes, of which those that no other has as a child are 0 and the last one.
std::string writeNodes(const ScratchFolder& folder, const std::string& nodes) {
  folder.write("a.bin", cornerBytes());
  const auto count = nlohmann::json::parse("[" + nodes + "]").size();
  return folder.write("a.gltf", gltf(nodes, count == 1 ? "0" : "0, " + std::to_string(count - 1)));
}

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("duplicate vertices are not merged, and degenerate faces stay in place") {
  const ScratchFolder folder;
  const MeshData mesh = readWhole(
      folder.write("a.ply", plyHeader(5, 3) + "0 0 0\n1 0 0\n0 1 0\n0 0 0\n9 9 9\n3 0 1 2\n3 0 0 0\n3 3 1 3\n"));
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
  CHECK(corners(readWhole(file)) == std::vector<float>{10, 0, 0, 11, 0, 0, 10, 1, 0,  //
                                                       10, 0, 0, 12, 0, 0, 10, 3, 0,  //
                                                       10, 0, 7, 11, 0, 7, 10, 1, 7,  //
                                                       0,  0, 0, 1,  0, 0, 0,  1, 0});
}

TEST_CASE("what a mirroring node places is wound the other way round in a mesh, and as it is stored in an assembly") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"mesh": 0, "scale": [-2, 1, 1], "children": [1, 2]},
    {"mesh": 0, "scale": [1, 1, -3]}, {"mesh": 0, "matrix": [0, 1, 0, 0, 1e-200, 0, 0, 0, 0, 0, 1e-200, 0, 0, 0, 5, 1]},
    {"mesh": 0, "scale": [-1, -1, 1]})");
  CHECK(corners(readWhole(file)) == std::vector<float>{0, 0, 0, 0,  1, 0, -2, 0,  0,  //
                                                       0, 0, 0, -2, 0, 0, 0,  1,  0,  //
                                                       0, 0, 5, 0,  1, 5, 0,  0,  5,  //
                                                       0, 0, 0, -1, 0, 0, 0,  -1, 0});
  std::vector<std::string> warnings;
  const Assembly assembly = readAssembly(file, warnings);
  REQUIRE(assembly.meshes.size() == 1);
  CHECK(corners(assembly.meshes[0]) == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  // Collada's nodes, too.
  const std::string node =
      R"(<node><matrix>0 1 0 7 1 0 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>)";
  CHECK(corners(readWhole(folder.write("a.dae", radar::test::collada(node, "0 1 2", 1)))) ==
        std::vector<float>{7, 0, 0, 8, 0, 0, 7, 1, 0});
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
  CHECK(assembly.parts[0].fileFromNode.m == std::array<double, 12>{2, 0, 0, 10, 0, 3, 0, 0, 0, 0, 4, 0});
  CHECK(assembly.parts[1].fileFromNode.m == std::array<double, 12>{1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 7});
  CHECK(corners(assembly.meshes[0]) == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});

  CHECK(corners(readWhole(file + "#1")) == corners(assembly.meshes[0]));
  CHECK(readWhole(file + "#2").triangleCount() == 2);
  CHECK_THAT(refusalOf(file + "#3"), Contains("expected one of the 3 nodes, from 0"));
  CHECK_THAT(refusalOf(file + "#"), Contains("#: expected one of the 3 nodes"));
  CHECK_THAT(refusalOf(file + "#99999999999"), Contains("one of the 3 nodes"));
  CHECK_THAT(refusalOf(file + "#lid"), Contains("that 2 have"));
  CHECK_THAT(refusalOf(file + "#frame"), Contains("that none has"));
}

TEST_CASE("a node may be named by what it alone is called, and a # in the name of a file is part of it") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"name": "a#b", "mesh": 1}, {"name": "in/out", "mesh": 0})");
  CHECK(readWhole(file + "#a#b").triangleCount() == 2);
  CHECK(readWhole(file + "#in/out").triangleCount() == 1);
  const std::string odd = folder.write("odd#0.obj", std::string(kSquare) + "f 1 2 3 4\n");
  CHECK(readWhole(odd).triangleCount() == 2);
  CHECK(readWhole(odd + "#0").triangleCount() == 2);
}

TEST_CASE("an assembly with a node that flattens its mesh is refused") {
  const ScratchFolder folder;
  const std::string file = writeNodes(folder, R"({"name": "flat", "mesh": 0, "scale": [1, 0, 1]})");
  std::vector<std::string> warnings;
  CHECK_THROWS_WITH(readAssembly(file, warnings), Contains("node \"flat\": expected an invertible matrix"));
}

TEST_CASE("the message about a broken mesh file names the file, the place and what was expected") {
  const ScratchFolder folder;
  CHECK_THAT(refusalOf((folder.path() / "missing.obj").string()), Contains("no such file"));
  CHECK_THAT(refusalOf(folder.path().string()), Contains("folder"));
  const std::string square = kSquare, three = "0 0 0\n1 0 0\n0 1 0\n", rest = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string large = "0 0 0\n1 0 0\n0 1e39 0\n3 0 1 2\n", got = " in the range of floats, got \"1e39\"";
  const std::string solid = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", off = "OFF\n3 1 0\n";
  const std::string facet = solid + "vertex 1 0 0\nvertex 0 1 0\n";
  const struct {
    const char* name;
    std::string content, words, place{};
  } files[] = {
      {"empty.ply", "", "empty"},
      {"text.xyz", "no mesh at all", "assimp"},
      {"none.obj", square, "at least one triangle"},
      {"line.obj", square + "l 1 2\n", "1 line"},
      {"nan.obj", "v nan 0 0\n" + rest, "vertex 0"},
      {"inf.ply", plyHeader(3, 1) + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "vertex 1"},
      // A number that is too large is named as it is written, and what only begins with a number is none.
      {"large.off", off + large, "line 5: expected a number" + got},
      {"large.ply", plyHeader(3, 1) + large, "vertex 2: expected a coordinate" + got},
      {"large.obj", "v 0 0 1e39\n" + rest, "line 1: expected a number" + got},
      {"large.stl", "solid a\nfacet\nouter loop\nvertex 0 1e39 0\n", "line 4: expected a number" + got},
      {"comma.obj", "v 0 0,5 0\n" + rest, "line 1: expected"},
      {"suffix.obj", "v 0 0 1.5f\n" + rest, "line 1: expected"},
      {"two.obj", "v 1 2\n" + rest, "line 1: expected"},
      {"five.obj", "v 1 2 3 4 5\n" + rest, "line 1: expected"},
      {"seven.obj", "v 1 2 3 4 5 6 7\n" + rest, "line 1: expected"},
      {"zero.obj", "v\n" + rest, "line 1: expected"},
      {"index.obj", square + "f 1 2 9\n", "line 5: expected one of the file's 4"},
      {"index.ply", plyHeader(3, 1) + three + "3 0 1 3\n", "face 0"},
      {"index.off", off + three + "3 0 1 3\n", "face 0", "line 6"},
      {"sign.off", off + three + "3 0 1 -1\n", "\"-1\""},
      {"cut.ply", plyHeader(3, 2) + three + "3 0 1 2\n", "element face"},
      {"cut2.ply", plyHeader(4, 1) + three, "element vertex"},
      {"cut3.ply", "ply\nformat ascii 1.0\n", "header"},
      {"cut.off", "OFF\n3 2 0\n" + three + "3 0 1 2\n", "face 1"},
      {"cut2.off", off + three + "3 0 1\n", "line 6: expected face 0"},
      {"cut.stl", solid, "line 5: expected endfacet"},
      {"cut2.stl", facet + "endloop\nendfacet\n", "endsolid"},
      // What a reader would have to leave out.
      {"four.stl", facet + "vertex 1 1 0\nendloop\nendfacet\nendsolid\n", "line 7: expected a facet of 3 vertices"},
      {"surface.obj", square + "f 1 2 3\ncstype bezier\nsurf 0 1 0 1 1 2 3\nend\n", "free-form", "line 7"},
  };
  for (const auto& file : files) {
    CAPTURE(file.name);
    CHECK_THAT(refusalOf(folder.write(file.name, file.content)), Contains(file.words) && Contains(file.place));
  }
}

TEST_CASE("an STL file is binary or text by what it holds, whatever its first word or the case of its name") {
  const ScratchFolder folder;
  std::string binary = "solid of an exporter";
  binary.resize(80, ' ');
  binary += std::string("\1\0\0\0", 4) + std::string(12, '\0');
  binary += cornerBytes() + std::string(2, '\0');
  CHECK(readWhole(folder.write("PART.STL", binary)).triangleCount() == 1);
  const std::string expected = "expected 134 bytes, as its 1 facets take in a binary file, got ";
  CHECK_THAT(refusalOf(folder.write("long.stl", binary + "?")), Contains("long.stl: " + expected + "135"));
  CHECK_THAT(refusalOf(folder.write("cut.stl", binary.substr(0, 100))), Contains("cut.stl: " + expected + "100"));
  const std::string capitals =
      "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID "
      "A\n";
  CHECK(readWhole(folder.write("capitals.stl", capitals)).triangleCount() == 1);
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
  CHECK(assembly.parts[0].fileFromNode.m == std::array<double, 12>{0, 0, -1, 0.1, 1, 0, 0, 0.3, 0, -1, 0, 0});
  CHECK(assembly.parts[1].fileFromNode.m == std::array<double, 12>{0, -3, 0, 0.1, 0, 0, 4, 0, -2, 0, 0, 0});
  CHECK(assembly.parts[2].fileFromNode.m == std::array<double, 12>{0.1, 0, 0, 1, 0, 0.2, 0, 2, 0, 0, 0.3, 0.7});
}

TEST_CASE("triangle strips of a PLY file turn as their first triangles, and what only leads on is left out") {
  const ScratchFolder folder;
  const auto header = [](const std::string& format) {
    return "ply\nformat " + format + " 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n" +
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  };
  const std::vector<int> strip{0, 1, 2, 3, -1, 3, 4, 5, 5, 0, 0, 1, 2};
  const std::vector<uint32_t> expected{0, 1, 2, 2, 1, 3, 3, 4, 5, 1, 0, 2};
  std::string text = header("ascii") + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 0\n5 1 0\n13";
  for (const int corner : strip) text += " " + std::to_string(corner);
  CHECK(readWhole(folder.write("a.ply", text + "\n")).indices == expected);
  std::string little = header("binary_little_endian"), big = header("binary_big_endian");
  const auto add = [&](auto value) {
    std::string bytes;
    append(bytes, value);
    little += bytes;
    std::ranges::reverse(bytes);
    big += bytes;
  };
  for (const float number : {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 5, 0, 0, 5, 1, 0}) add(number);
  add(static_cast<int>(strip.size()));
  for (const int corner : strip) add(corner);
  CHECK(readWhole(folder.write("little.ply", little)).indices == expected);
  CHECK(readWhole(folder.write("big.ply", big)).indices == expected);
  CHECK_THAT(refusalOf(folder.write("b.ply", header("ascii") + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 0\n5 1 0\n3 0 1 6\n")),
             Contains("tristrips 0: expected the number of a vertex, or -1, below 6, got \"6\""));
}

TEST_CASE("a binary PLY file that ends early is refused") {
  const ScratchFolder folder;
  std::string content = plyHeader(3, 1, "binary_little_endian") + cornerBytes();
  for (char byte : {3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}) content += byte;
  CHECK(readWhole(folder.write("whole.ply", content)).triangleCount() == 1);
  for (size_t cut : {1u, 5u, 13u, 14u, 40u}) {
    CAPTURE(cut);
    refusalOf(folder.write("cut.ply", content.substr(0, content.size() - cut)));
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
