// Mesh files that tests write, and what readMesh makes of them.
#pragma once

#include "import/mesh_import.h"
#include "support/catch.h"
#include "support/scratch_folder.h"
#include "support/threemf.h"

namespace radar::test {

/// Without any warning.
inline tools::FileMesh readWhole(const std::string& file) {
  std::vector<std::string> warnings;
  tools::FileMesh mesh = tools::readMesh(file, warnings);
  CHECK(warnings.empty());
  return mesh;
}

/// The message with which a file is refused.
inline std::string refusalOf(const std::string& file) {
  std::vector<std::string> warnings;
  try {
    tools::readMesh(file, warnings);
  } catch (const tools::InputError& error) {
    CHECK_THAT(error.what(), Contains(file) && Contains("expected"));
    return error.what();
  }
  FAIL("not refused: " << file);
  return {};
}

inline std::string plyHeader(size_t vertices, size_t faces, const std::string& format = "ascii",
                             const std::string& type = "float") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\nproperty " + type +
         " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

/// The bytes of the corners (0, 0, 0), (1, 0, 0) and (0, 1, 0).
inline std::string cornerBytes() {
  std::string bytes;
  append(bytes, std::array<float, 9>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  return bytes;
}

/// A glTF file of two meshes, of one triangle and of two, whose corners are the bytes of `uri`; `nodes` and `roots` are
/// lists.
inline std::string gltf(const std::string& nodes, const std::string& roots = "0", const std::string& uri = "a.bin") {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [)" + roots + R"(]}], "nodes": [)" + nodes +
         R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]},
    {"primitives": [{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": ")" +
         uri + R"(", "byteLength": 36}]})";
}

/// A Collada file of one geometry, "g", that has as many triangles; `corners` number its vertices (0, 0, 0), (1, 0, 0)
/// and (0, 1, 0).
inline std::string collada(const std::string& nodes, const std::string& corners, size_t triangles) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#f" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")" +
         std::to_string(triangles) + R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)" + corners +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">" +
         nodes + R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

}  // namespace radar::test
