// Fuzzes the readers of OBJ, STL, PLY, OFF, glTF and 3MF. The first byte of an input chooses the format, the rest is
// the file; of 3MF, a whole archive or the model in one.
#include <algorithm>
#include <cmath>

#include "fuzz/target.h"
#include "import/mesh_facts.h"
#include "import/mesh_import.h"
#include "import/regular_file.h"
#include "support/scratch_folder.h"
#include "support/threemf.h"

namespace radar::fuzz {

namespace {

using tools::Assembly;
using tools::MeshData;

constexpr const char* kFormats[] = {".obj", ".stl", ".ply", ".off", ".gltf", ".3mf"};

/// The corners of all triangles, in order.
void appendCorners(const MeshData& mesh, std::vector<float>& corners) {
  for (const uint32_t index : mesh.indices) {
    corners.insert(corners.end(), &mesh.positions[3 * size_t(index)], &mesh.positions[3 * size_t(index)] + 3);
  }
}

void checkMesh(const MeshData& mesh) {
  require(mesh.positions.size() % 3 == 0 && mesh.indices.size() % 3 == 0, "not 3 numbers for each");
  require(!mesh.indices.empty(), "no triangle");
  require(std::ranges::all_of(mesh.positions, [](float x) { return std::isfinite(x); }), "a position is not finite");
  require(std::ranges::all_of(mesh.indices, [&](uint32_t i) { return i < mesh.vertexCount(); }), "no such vertex");
}

void checkMessage(const std::string& words) {
  const auto isControl = [](char c) { return (c >= 0 && c < 32) || c == 127; };
  require(words.size() < 3000 && std::ranges::none_of(words, isControl), "a message that cannot be printed");
  require(words.find("expected") != words.npos, "a message that does not say what was expected: " + words);
}

void run(std::string_view input) {
  static const test::ScratchFolder folder;
  if (input.empty()) return;
  const auto format = static_cast<unsigned char>(input[0] - '0') % std::size(kFormats);
  const std::string name = std::string("a") + kFormats[format];
  // Some file systems write a file that is overwritten to the disk at once.
  std::filesystem::remove(folder.path() / name);
  std::string content(input.substr(1));
  // Few mutated archives have the checksums that they give.
  if (name == "a.3mf" && !content.starts_with("PK")) content = test::archiveOf(content, false);
  const std::string file = folder.write(name, content);
  std::vector<std::string> warnings;
  tools::FileMesh mesh;
  try {
    mesh = tools::readMesh(file, warnings);
  } catch (const tools::InputError& error) {
    return checkMessage(error.what());
  }
  checkMesh(mesh);
  tools::factsOf(mesh);
  if (name == "a.gltf") return;
  // The parts of an assembly have the same triangles, since no node of the other formats is moved.
  const Assembly assembly = tools::readAssembly(file, warnings);
  const auto isMoved = [](const Assembly::Part& part) { return part.fileFromNode != Transform{}; };
  const auto isBased = [](const tools::FileMesh& of) { return of.base != std::array<double, 3>{}; };
  if (isBased(mesh) || std::ranges::any_of(assembly.meshes, isBased) || std::ranges::any_of(assembly.parts, isMoved)) {
    return;
  }
  std::vector<float> whole, parts;
  appendCorners(mesh, whole);
  for (const Assembly::Part& part : assembly.parts) {
    const MeshData& own = assembly.meshes.at(part.mesh);
    checkMesh(own);
    appendCorners(own, parts);
  }
  require(whole == parts, "an assembly of other triangles");
  tools::readMesh(file + "#0", warnings);
}

std::vector<std::string> seeds() {
  const std::string models = RADAR_ASSIMP_MODELS "/";
  std::vector<std::string> seeds;
  for (const char* name :
       {"OBJ/box.obj", "OBJ/testmixed.obj", "OBJ/number_formats.obj", "OBJ/cube_usemtl.obj", "OBJ/testline.obj",
        "STL/triangle_with_two_solids.stl", "STL/triangle_with_empty_solid.stl", "PLY/cube.ply", "PLY/cube_binary.ply",
        "PLY/float-color.ply", "PLY/points.ply", "OFF/Cube.off"}) {
    const std::string content = tools::readRegularFile(models + name, "a model");
    const auto format = std::ranges::find(kFormats, std::filesystem::path(name).extension()) - std::begin(kFormats);
    seeds.push_back(static_cast<char>('0' + format) + content);
  }
  for (const char* name : {"BoxTextured-glTF-Embedded/BoxTextured.gltf", "simple_skin/simple_skin.gltf",
                           "BoxTextured-glTF-Binary/BoxTextured.glb"}) {
    seeds.push_back('4' + tools::readRegularFile(models + "glTF2/" + name, "a model"));
  }
  seeds.push_back('5' + tools::readRegularFile(models + "3MF/box.3mf", "a model"));
  seeds.emplace_back(
      R"(5<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1"
name="a"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object><object id="2"><components><component objectid="1"/>
</components></object></resources><build><item objectid="2"/><item objectid="1"/></build></model>)");
  std::string binaryStl(84 + 50, '\0');
  binaryStl[80] = 1;
  seeds.push_back('1' + binaryStl);
  seeds.push_back(
      std::string("2ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                  "property double z\nproperty list uchar short extra\nelement face 1\nproperty list int "
                  "ushort vertex_index\nend_header\n") +
      std::string(100, '\0'));
  seeds.emplace_back("3OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
  seeds.emplace_back("34OFF\n3 1 0 # counts\n0 0 0 1\n1 0 0 2\n0 1 0 1\n3 0 1 2 255 0 0\n");
  seeds.emplace_back(
      "0o a\\\n b\ng c\nv 1 2 3 0.5\nv 0 0 0 1 1 1\nv 1e-50 +3 -0\nf -1 -2 -3\nl 1 2 3\np 1\nf 1/1 2//1 3/1/1\n");
  return seeds;
}

constexpr const char* kWords =
    "v ~f ~l ~p ~o ~g ~usemtl ~surf ~\\\n~solid ~facet normal ~outer loop~vertex ~endloop~endfacet~endsolid~"
    "ply\n~format ascii 1.0\n~format binary_little_endian 1.0\n~format binary_big_endian 1.0\n~"
    "element vertex ~element face ~property list uchar int vertex_indices\n~property float x\n~"
    "property double y\n~end_header\n~tristrips~4OFF\n~STOFF\n~#~-1~4294967295~4294967296~"
    "18446744073709551615~\"sparse\":{~\"skin\":0~\"children\":[0]~\"byteStride\":~\"normalized\":true~<component "
    "objectid=\"1\"/>~<object id=\"3\">~<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 0\"/>~"
    "<vertex x=\"1\" y=\"2\" z=\"3\"/>~<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>~ "
    "requiredextensions=\"p\"~5120~5126~1e999~"
    "1e-999~nan~inf~0x1p3~\n~\xef\xbb\xbf~\xff\xff\xff\xff";

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, separated(kWords)};
  return kTarget;
}

}  // namespace radar::fuzz
