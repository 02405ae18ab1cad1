// 3MF files: zip archives of XML.
#include <zlib.h>

#include "mesh_texts.h"

using namespace radar::tools;
using radar::test::append;
using radar::test::Contains;
using radar::test::readWhole;
using radar::test::refusalOf;
using radar::test::ScratchFolder;

namespace {

/// A zip archive: `deflated`, or stored; `streamed`: sizes are zero in front of a file's bytes, and 64-bit in the list.
std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files, bool deflated, bool streamed) {
  std::string bytes, list;
  for (const auto& [name, content] : files) {
    std::string packed = content;
    if (deflated) {
      uLongf size = compressBound(content.size());
      packed.resize(size);
      REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(content.data()),
                       content.size()) == Z_OK);
      packed = packed.substr(2, size - 6);  // without zlib's head and checksum
    }
    const auto check =
        static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())));
    const auto offset = static_cast<uint32_t>(bytes.size());
    const auto head = [&](std::string& to, bool isListed) {
      append(to, uint32_t(isListed ? 0x02014b50 : 0x04034b50));
      if (isListed) append(to, uint16_t(45));
      append(to, uint16_t(45));
      append(to, uint16_t(streamed ? 8 : 0));
      append(to, uint16_t(deflated ? 8 : 0));
      append(to, uint32_t(0));  // when
      append(to, isListed || !streamed ? check : 0u);
      append(to, streamed ? (isListed ? UINT32_MAX : 0u) : uint32_t(packed.size()));
      append(to, streamed ? (isListed ? UINT32_MAX : 0u) : uint32_t(content.size()));
      append(to, uint16_t(name.size()));
    };
    head(bytes, false);
    append(bytes, uint16_t(0));
    bytes += name + packed;
    head(list, true);
    append(list, uint16_t(streamed ? 20 : 0));
    list.append(10, '\0');  // no remark, where the archive begins, what kind of file
    append(list, offset);
    list += name;
    if (!streamed) continue;
    append(list, uint16_t(1));
    append(list, uint16_t(16));
    append(list, uint64_t(content.size()));
    append(list, uint64_t(packed.size()));
  }
  const auto at = static_cast<uint32_t>(bytes.size());
  bytes += list + "PK\5\6" + std::string(4, '\0');
  for (int i = 0; i < 2; ++i) append(bytes, static_cast<uint16_t>(files.size()));
  append(bytes, static_cast<uint32_t>(list.size()));
  append(bytes, at);
  return bytes + std::string(2, '\0');
}

constexpr const char* kTriangle =
    R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh>)";

std::string modelOf(const std::string& resources, const std::string& build, const std::string& more = "") {
  return R"(<?xml version="1.0" encoding="UTF-8"?><model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )" +
         more + "><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

std::string archiveOf(const std::string& model, bool deflated = true, bool streamed = false) {
  return zipOf({{"_rels/.rels",
                 R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/Metadata/thumbnail.png" Id="r1" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="/3D/a.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)"},
                {"Metadata/thumbnail.png", "\x89PNG"},
                {"3D/a.model", model}},
               deflated, streamed);
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
