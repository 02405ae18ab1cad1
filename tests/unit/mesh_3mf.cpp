// 3MF files: zip archives of XML.
#include "mesh_texts.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

constexpr const char* kTriangle =
    R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh>)";

std::string modelOf(const std::string& resources, const std::string& build, const std::string& more = "") {
  return R"(<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )" +
         more + "><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

}  // namespace

TEST_CASE("a 3MF file with a thumbnail is read, stored, deflated or streamed") {
  const ScratchFolder folder;
  const std::string model =
      modelOf(std::string("<object id=\"1\" type=\"model\">") + kTriangle + "</object>", "<item objectid=\"1\"/>");
  for (const bool deflated : {false, true}) {
    for (const bool streamed : {false, true}) {
      const MeshData mesh = readWhole(folder.write("a.3mf", archiveOf(model, deflated, streamed)));
      CHECK(mesh.positions == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    }
  }
}

TEST_CASE("the numbers of a 3MF file stay as they are, and a warning names a unit that is not the millimetre") {
  const ScratchFolder folder;
  const std::string object = std::string("<object id=\"1\">") + kTriangle + "</object>";
  for (const std::string unit : {"inch", "micron", "millimeter", ""}) {
    std::string model = modelOf(object, "<item objectid=\"1\"/>");
    model.replace(model.find("millimeter"), 10, unit);
    if (unit.empty()) model.erase(model.find("unit=\"\""), 7);
    CAPTURE(unit);
    std::vector<std::string> warnings;
    CHECK(readMesh(folder.write("a.3mf", archiveOf(model)), warnings).positions ==
          std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    const bool isOdd = unit == "inch" || unit == "micron";
    REQUIRE(warnings.size() == (isOdd ? 1 : 0));
    if (isOdd) CHECK_THAT(warnings[0], Contains("a.3mf: its unit is " + unit + ", not millimeter"));
  }
}

TEST_CASE("build items and components of a 3MF file place its objects, whose meshes they share") {
  const ScratchFolder folder;
  const std::string model =
      modelOf(std::string("<object id=\"1\" name=\"lid\">") + kTriangle +
                  R"(</object><object id="2"><components><component objectid="1"/>
<component objectid="1" transform="0 2 0 -2 0 0 0 0 2 10 20 30"/></components></object>)",
              R"(<item objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 0"/><item objectid="1"/>)");
  std::vector<std::string> warnings;
  const Assembly assembly = readAssembly(folder.write("a.3mf", archiveOf(model)), warnings);
  REQUIRE(assembly.parts.size() == 3);
  CHECK(assembly.meshes.size() == 1);
  CHECK(assembly.parts[0].name == "lid");
  CHECK(assembly.parts[0].fileFromNode.m == std::array<double, 12>{1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0});
  CHECK(assembly.parts[1].fileFromNode.m == std::array<double, 12>{0, -2, 0, 110, 2, 0, 0, 20, 0, 0, 2, 30});
  CHECK(assembly.parts[2].fileFromNode == radar::Transform{});
}

TEST_CASE("a 3MF file that is broken, or needs what is not read, is refused by name") {
  const ScratchFolder folder;
  const std::string object = std::string("<object id=\"1\">") + kTriangle + "</object>",
                    item = "<item objectid=\"1\"/>";
  const std::string whole = archiveOf(modelOf(object, item)),
                    path = R"( xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06")";
  for (const auto& [content, words] :
       {std::pair{std::string("PK\3\4 cut"), "expected a zip archive"},
        std::pair{whole.substr(0, whole.size() - 30), "expected a zip archive"},
        std::pair{archiveOf(modelOf(object, "<item objectid=\"7\"/>")), "expected an object's id, got 7"},
        std::pair{
            archiveOf(modelOf("<object id=\"1\"><components><component objectid=\"1\"/></components></object>", item)),
            "nested at most 100 deep"},
        std::pair{archiveOf(modelOf(object, item, R"(xmlns:s="urn:slices" requiredextensions="s")")), "got urn:slices"},
        std::pair{archiveOf(modelOf(object, R"(<item objectid="1" p:path="/3D/b.model"/>)", path)),
                  "production extension"},
        std::pair{archiveOf(modelOf(object + "<object", item)), "expected XML"},
        std::pair{archiveOf("<!DOCTYPE a [<!ENTITY b \"c\">]>" + modelOf(object, item).substr(38)), "no DOCTYPE"}}) {
    CAPTURE(words);
    CHECK_THAT(refusalOf(folder.write("a.3mf", content)), Contains(words));
  }
  for (size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x41);
    std::vector<std::string> warnings;
    try {
      const FileMesh mesh = readMesh(folder.write("b.3mf", damaged), warnings);
      CHECK(mesh.triangleCount() == 1);
    } catch (const InputError&) {
    }
  }
}
