// Mesh files in another unit than the scene.
#include <nlohmann/json.hpp>

#include "batch/query_file.h"
#include "mesh_texts.h"

using namespace radar::tools;
using namespace radar::test;
using radar::transformPoint;

namespace {

constexpr const char* kSmall = "v 1 2 3\nv 1234.567 2 3\nv 1 3333.333 3\no lid\nf 1 2 3\n";

nlohmann::json queriesOn(const nlohmann::json& mesh, const nlohmann::json& assembly) {
  return {{"format", "cyber-radar-queries-1"},
          {"meshes", {mesh}},
          {"scenes", {{{"assembly", assembly}}, {{"instances", {{0, 1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0}}}}}},
          {"queries", nlohmann::json::array()}};
}

QueryFile read(const ScratchFolder& folder, const nlohmann::json& file) {
  std::vector<std::string> warnings;
  return {folder.write("q.json", file.dump()), warnings};
}

nlohmann::json scaled(const char* file, double scale) {
  return {{"file", file}, {"scale", scale}};
}

}  // namespace

TEST_CASE("a file's numbers are scaled in double precision, and rounded once") {
  const ScratchFolder folder;
  folder.write("a b.obj", kSmall);
  for (const char* name : {"a b.obj", "a b.obj#lid"}) {
    const QueryFile file = read(folder, queriesOn(scaled(name, 0.001), scaled("a b.obj", 1e3)));
    const Workload& world = file.world();
    REQUIRE(world.meshes.size() == 2);
    CHECK(world.meshes[0].name == name);
    CHECK(world.meshes[0].positions[3] == static_cast<float>(0.001 * 1234.567));
    CHECK(world.meshes[0].positions[7] == static_cast<float>(0.001 * 3333.333));
    CHECK(world.meshes[1].positions[3] == static_cast<float>(1e3 * 1234.567));
    CHECK(world.scenes[1].instances[0].worldFromMesh.m[3] == 5);  // poses are in the scene's unit
  }
}

TEST_CASE("the transforms of nodes are scaled with their meshes, however the file is read") {
  const ScratchFolder folder;
  folder.write("a.bin", radar::test::cornerBytes());
  const std::string file = folder.write(
      "a.gltf", gltf(R"({"mesh": 0, "translation": [3, 0, 0], "scale": [2, 2, 2]}, {"mesh": 0, "name": "x"})", "0, 1"));
  std::vector<std::string> warnings;
  const FileMesh whole = readMesh(file, warnings, 0.5);
  CHECK(whole.positions == std::vector<float>{1.5, 0, 0, 2.5, 0, 0, 1.5, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0.5, 0});
  const Assembly assembly = readAssembly(file, warnings, 0.5);
  REQUIRE(assembly.meshes.size() == 1);
  CHECK(assembly.meshes[0].positions[3] == 0.5);
  for (size_t corner = 0; corner < 6; ++corner) {
    const auto at =
        transformPoint(assembly.parts[corner / 3].fileFromNode, &assembly.meshes[0].positions[3 * (corner % 3)]);
    for (size_t k = 0; k < 3; ++k) CHECK(at[k] == whole.positions[3 * corner + k]);
  }
}

TEST_CASE("numbers that are far away once they are scaled are about a base, and others no longer") {
  const ScratchFolder folder;
  const std::string file = folder.write("far.obj",
                                        "v 512340678 4512350123 296250\nv 512350678 4512350123 296250\n"
                                        "v 512340678 4512360123 296250\nf 1 2 3\n");
  std::vector<std::string> warnings;
  const FileMesh metres = readMesh(file, warnings, 0.001);
  CHECK(metres.base != std::array<double, 3>{});
  const auto corner = transformPoint(aboutBase({}, metres.base), &metres.positions[0]);
  CHECK(corner[0] == Approx(512340.678).epsilon(0).margin(1e-6));
  CHECK(corner[1] == Approx(4512350.123).epsilon(0).margin(1e-6));
  CHECK(warnings.empty());
}

TEST_CASE("a scale that is no positive number is refused, and one that leaves the range of floats") {
  const ScratchFolder folder;
  const std::string file = folder.write("a.obj", kSmall);
  std::vector<std::string> warnings;
  for (const double scale : {0.0, -0.001, std::nan(""), HUGE_VAL}) {
    CAPTURE(scale);
    for (const std::string& name : {file, file + "#lid"}) {
      CHECK_THROWS_WITH(readMesh(name, warnings, scale), Contains("scale: expected a finite number above 0, got"));
    }
    CHECK_THROWS_WITH(readAssembly(file, warnings, scale), Contains("expected a finite number above 0"));
  }
  CHECK_THROWS_WITH(
      readMesh(file, warnings, 1e38),
      Contains("vertex 1: expected 3 finite numbers, got 1234.57 2 3 before the node's transform and the scale 1e+38"));
  CHECK_THROWS_WITH(read(folder, queriesOn(scaled("a.obj", -2), "a.obj")),
                    Contains("meshes[0]: ") && Contains("above 0, got -2"));
  CHECK_THROWS_WITH(read(folder, queriesOn("a.obj", scaled("a.obj", 0))), Contains("scenes[0].assembly: "));
  CHECK_THROWS_WITH(read(folder, queriesOn({{"file", "a.obj"}, {"unit", "mm"}}, "a.obj")),
                    Contains("meshes[0].unit: expected one of the keys file, scale"));
  CHECK_THROWS_WITH(read(folder, queriesOn({{"scale", 2}}, "a.obj")), Contains("the key \"file\", which is missing"));
  CHECK_THROWS_WITH(read(folder, queriesOn({{"file", "a.obj"}, {"scale", "2"}}, "a.obj")),
                    Contains("meshes[0].scale: expected a finite number"));
}

TEST_CASE("a scale is part of a query file's fingerprint, and a mesh that is written has it in its numbers") {
  const ScratchFolder folder;
  folder.write("a.obj", kSmall);
  const QueryFile small = read(folder, queriesOn(scaled("a.obj", 0.001), "a.obj"));
  CHECK(small.fingerprint() != read(folder, queriesOn(scaled("a.obj", 1), "a.obj")).fingerprint());
  std::vector<std::string> warnings;
  const QueryFile again(writeQueryFile(small.world(), folder.path() / "again"), warnings);
  CHECK(again.world().meshes[0].positions == small.world().meshes[0].positions);
}
