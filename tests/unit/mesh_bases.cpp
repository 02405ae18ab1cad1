// Mesh files whose numbers floats cannot hold, or whose axes and units are not the program's.
#include <cmath>

#include "batch/binary_queries.h"
#include "batch/query_file.h"
#include "mesh_texts.h"
#include "workloads/random.h"

using namespace radar::tools;
using namespace radar::test;
using radar::Transform;

namespace {

/// A wall of 10 m by 10 m in UTM metres.
constexpr const char* kWall =
    "v 512340.678 4512350.123 296.25\nv 512350.678 4512350.123 296.25\nv 512350.678 4512350.123 306.25\n"
    "v 512340.678 4512350.123 306.25\nf 1 2 3 4\n";
constexpr const char* kSmall = "v 0.1 0.2 0.3\nv 1.1 0.2 0.3\nv 0.1 1.2 0.3\nf 1 2 3\n";

std::array<double, 3> corner(const FileMesh& mesh, size_t i, const Transform& worldFromFile = {}) {
  return radar::transformPoint(aboutBase(worldFromFile, mesh.base), &mesh.positions[3 * i]);
}

/// A Collada file of a triangle.
std::string collada(const std::string& asset) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset + R"(</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">
1 2 3 4 2 3 1 6 3</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";
}

}  // namespace

TEST_CASE("a mesh far from the origin is about a base, which poses give back") {
  const ScratchFolder folder;
  std::vector<std::string> warnings;
  const FileMesh wall = readMesh(folder.write("wall.obj", kWall), warnings);
  CHECK(warnings.empty());
  CHECK(wall.base != std::array<double, 3>{});
  CHECK(corner(wall, 0)[0] == Approx(512340.678).epsilon(0).margin(1e-6));
  CHECK(corner(wall, 0)[1] == Approx(4512350.123).epsilon(0).margin(1e-6));
  // A quarter turn about z that brings the corner near the origin.
  const std::array<double, 3> turned = corner(wall, 0, {{0, -1, 0, 4512350, 1, 0, 0, -512340, 0, 0, 1, -296}});
  CHECK(turned[0] == Approx(-0.123).epsilon(0).margin(1e-6));
  CHECK(turned[1] == Approx(0.678).epsilon(0).margin(1e-6));
  CHECK(turned[2] == Approx(0.25).epsilon(0).margin(1e-6));
  const Assembly assembly = readAssembly((folder.path() / "wall.obj").string(), warnings);
  CHECK(corner(assembly.meshes[0], 0, assembly.parts[0].fileFromNode) == corner(wall, 0));
}

TEST_CASE("numbers that floats round by less than a millionth of the mesh's size are the nearest floats") {
  const ScratchFolder folder;
  std::vector<std::string> warnings;
  const FileMesh mesh = readMesh(folder.write("a.obj", kSmall), warnings);
  CHECK(mesh.base == std::array<double, 3>{});
  CHECK(mesh.positions == std::vector<float>{0.1f, 0.2f, 0.3f, 1.1f, 0.2f, 0.3f, 0.1f, 1.2f, 0.3f});
  CHECK(warnings.empty());
}

TEST_CASE("a warning says by how much floats change numbers where no base helps") {
  const ScratchFolder folder;
  const std::string stray = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 5 6 7\n";
  std::vector<std::string> warnings;
  readMesh(folder.write("a.obj", kWall + stray), warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("a.obj: floats, which vertices become, change its numbers by up to 0."));
  // Vertices that no triangle names do not count.
  warnings.clear();
  CHECK(corner(readMesh(folder.write("b.obj", std::string(kWall) + "v 0 0 0\n"), warnings), 0)[1] > 0);
  CHECK(warnings.empty());
}

TEST_CASE("random meshes about random bases are where their files say, to 2^-23 of their size") {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const double size = random.magnitude(-6, 6), far = random.magnitude(-2, 9);
    std::vector<double> positions;
    for (int k = 0; k < 9; ++k) positions.push_back(far * (k % 3 + 1) + size * random.uniform(-1, 1));
    const std::vector<uint32_t> corners{0, 1, 2};
    const FloatVertices floats = floatVertices(positions, corners);
    double most = 0;
    for (size_t k = 0; k < 9; ++k) {
      most = std::max(most, std::abs(positions[k] - floats.base[k % 3] - double(floats.positions[k])));
    }
    CHECK(floats.change == most);
    CHECK(most <= std::max(0x1p-20 * 2 * size, 0x1p-22 * size));
  }
}

TEST_CASE("objects, sensors and deformations of a query file are where the numbers of a far mesh put them") {
  const ScratchFolder folder;
  folder.write("wall.obj", kWall);
  folder.write("small.obj", kSmall);
  std::string bytes;
  for (const float x : {512340.f, 4512350.f, 296.f, 512350.f, 4512350.f, 296.f, 512350.f, 4512350.f, 306.f, 512340.f,
                        4512350.f, 306.f}) {
    radar::test::append(bytes, x);
  }
  folder.write("moved.f32", bytes);
  writePlaced(std::vector<Instance>{{0, {{1, 0, 0, -512340, 0, 1, 0, -4512350, 0, 0, 1, -296}}}, {1, {}}, {}},
              folder.path() / "objects.npy");
  const std::string file =
      folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["wall.obj", "small.obj"],
    "scenes": [{"instances_file": "objects.npy", "deforms": [[0, "moved.f32"]]},
               {"instances": [[0], [0, 2,0,0,0, 0,2,0,0, 0,0,2,0]]}],
    "queries": [{"id": "a", "scene": 0, "sensor": [0, 1,0,0,-512340, 0,1,0,-4512350, 0,0,1,-296], "dir": [1, 0, 0], "D": 1}]})");
  std::vector<std::string> warnings;
  const Workload all = QueryFile(file, warnings).all();
  CHECK(warnings.empty());
  const auto at = [&](const Transform& pose, std::span<const float> positions) {
    return radar::transformPoint(pose, positions.data());
  };
  const auto& wall = all.meshes[0].positions;
  const std::vector<Instance>& objects = all.scenes[0].instances;
  CHECK(at(objects[0].worldFromMesh, wall)[0] == Approx(0.678).epsilon(0).margin(1e-6));
  CHECK(objects[1].worldFromMesh == Transform{});
  CHECK(at(objects[2].worldFromMesh, wall)[1] == Approx(4512350.123).epsilon(0).margin(1e-6));
  CHECK(at(objects[0].worldFromMesh, all.scenes[0].deforms[0].positions) == std::array<double, 3>{0, 0, 0});
  CHECK(at(all.scenes[1].instances[1].worldFromMesh, wall)[0] == Approx(1024681.356).epsilon(0).margin(2e-6));
  CHECK(at(all.queries[0].worldFromMesh, wall)[1] == Approx(0.123).epsilon(0).margin(1e-6));
}

TEST_CASE("a Collada file lies where its numbers say, whatever axis is up in it and whatever its unit") {
  const ScratchFolder folder;
  const std::vector<float> expected{1, 2, 3, 4, 2, 3, 1, 6, 3};
  for (const char* asset : {"", "<up_axis>Z_UP</up_axis>", "<up_axis>X_UP</up_axis>", "<up_axis>Y_UP</up_axis>",
                            R"(<unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis>)"}) {
    CAPTURE(asset);
    CHECK(readWhole(folder.write("a.dae", collada(asset))).positions == expected);
  }
}

TEST_CASE("text in UTF-16 is refused, and a byte order mark of UTF-8 is not") {
  const ScratchFolder folder;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const auto wide = [](const std::string& narrow, bool isLittle) {
    std::string bytes;
    for (const char c : narrow) bytes += isLittle ? std::string{c, '\0'} : std::string{'\0', c};
    return bytes;
  };
  for (const auto& [name, content] :
       {std::pair{"a.obj", text}, std::pair{"a.off", off}, std::pair{"a.ply", std::string("ply\n")},
        std::pair{"a.stl", std::string("solid a\nfacet normal 0 0 1\nouter loop\n")}}) {
    CAPTURE(name);
    CHECK_THAT(refusalOf(folder.write(name, "\xff\xfe" + wide(content, true))), Contains("UTF-16"));
    CHECK_THAT(refusalOf(folder.write(name, "\xfe\xff" + wide(content, false))), Contains("UTF-16"));
  }
  CHECK_THAT(refusalOf(folder.write("a.obj", wide(text, true))), Contains("UTF-16"));
  CHECK(readWhole(folder.write("a.obj", "\xef\xbb\xbf" + text)).triangleCount() == 1);
  CHECK(readWhole(folder.write("a.off", "\xef\xbb\xbf" + off)).triangleCount() == 1);
}
