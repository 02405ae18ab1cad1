// Files from elsewhere: what would be read for ever, crash assimp, take all memory or end up in a message.
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "batch/query_file.h"
#include "mesh_texts.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

std::string refusalOfQueries(const std::string& file) {
  std::vector<std::string> warnings;
  try {
    QueryFile(file, warnings).all();
  } catch (const InputError& error) {
    return error.what();
  }
  FAIL("not refused: " << file);
  return {};
}

bool isPrintable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 32 && c < 127; });
}

}  // namespace

TEST_CASE("pipes, devices and folders are refused, as mesh files, query files and what these name") {
  const ScratchFolder folder;
  const std::string pipe = (folder.path() / "pipe.obj").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.ply");
  std::filesystem::create_directory(folder.path() / "folder.stl");
  CHECK_THAT(refusalOf(pipe), Contains("pipe.obj: expected a mesh file, got a pipe"));
  CHECK_THAT(refusalOf("/dev/zero"), Contains("/dev/zero: expected a mesh file, got a device"));
  CHECK_THAT(refusalOf((folder.path() / "zero.ply").string()), Contains("got a device"));
  CHECK_THAT(refusalOf((folder.path() / "folder.stl").string()), Contains("got a folder"));
  CHECK_THAT(refusalOfQueries(pipe), Contains("expected a query file, or - for standard input, got a pipe"));
  CHECK_THAT(refusalOfQueries("/dev/zero"), Contains("got a device"));
  const std::string head = R"({"format": "cyber-radar-queries-1", "meshes": [")";
  CHECK_THAT(refusalOfQueries(folder.write("q.json", head + "pipe.obj\"]}")),
             Contains("meshes[0]: ") && Contains("got a pipe"));
  CHECK_THAT(refusalOfQueries(folder.write("q.json", head + "/dev/zero\"]}")), Contains("got a device"));
  const std::string scene = "\"], \"scenes\": [{\"instances_file\": \"pipe.obj\"}], \"queries\": []}";
  folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  CHECK_THAT(refusalOfQueries(folder.write("q.json", head + "a.off" + scene)),
             Contains("scenes[0].instances_file: ") && Contains("got a pipe"));
  // A buffer of a glTF file.
  CHECK_THAT(refusalOf(folder.write("a.gltf", gltf(R"({"mesh": 0})", "0", "pipe.obj"))),
             Contains("a.gltf: buffers[0].uri: ") && Contains("the name of a regular file, got "));
  CHECK_THAT(refusalOf(folder.write("a.gltf", gltf(R"({"mesh": 0})", "0", "/dev/zero"))),
             Contains("a.gltf: buffers[0].uri: ") && Contains("the name of a regular file, got "));
}

TEST_CASE("a query file may name meshes outside its folder") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  const std::string mesh = folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const nlohmann::json file{{"format", "cyber-radar-queries-1"},
                            {"meshes", {"../a.off", mesh}},
                            {"scenes", nlohmann::json::array()},
                            {"queries", nlohmann::json::array()}};
  std::vector<std::string> warnings;
  CHECK(QueryFile(folder.write("sub/q.json", file.dump()), warnings).all().meshes.size() == 2);
}

TEST_CASE("a binary PLY file on which assimp crashes or never ends is refused") {
  const ScratchFolder folder;
  const std::string data(200, '\0');
  const std::string vertices = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 12\nproperty list uchar int vertex_indices\n";
  for (const std::string& header : {"format binary_little_endian 1.0\nproperty float x\n" + vertices + faces,
                                    "format binary_little_end\xff 1.0\n" + vertices + faces,
                                    "format binary_little_endian 1.0\nelement vertex 8\nproperty float x\n" + faces}) {
    CAPTURE(header);
    CHECK_THAT(refusalOf(folder.write("a.ply", "ply\n" + header + "end_header\n" + data)), Contains("expected"));
  }
}

TEST_CASE("nodes may be nested a hundred thousand deep") {
  const ScratchFolder folder;
  folder.write("a.bin", cornerBytes());
  std::string nodes;
  for (int i = 0; i < 100'000; ++i) {
    nodes += "{\"translation\": [1, 0, 0], \"children\": [" + std::to_string(i + 1) + "]}, ";
  }
  const MeshData mesh = readWhole(folder.write("a.gltf", gltf(nodes + "{\"mesh\": 0}")));
  CHECK(mesh.positions == std::vector<float>{1e5f, 0, 0, 100001, 0, 0, 1e5f, 1, 0});
}

TEST_CASE("nodes that place a mesh too often are refused before it is copied, and an assembly shares it") {
  const ScratchFolder folder;
  // A Collada file: 2^12 nodes of a mesh of 2^16 triangles and more.
  std::string corners, nodes;
  for (int i = 0; i < 65'537; ++i) corners += "0 1 2 ";
  for (int i = 0; i < 4096; ++i) {
    nodes += "<node id=\"n" + std::to_string(i) + "\"><instance_geometry url=\"#g\"/></node>\n";
  }
  const std::string file = folder.write("many.dae", radar::test::collada(nodes, corners, 65'537));
  CHECK_THAT(refusalOf(file),
             Contains("expected at most 134217728 vertices and triangles") && Contains("as nodes place"));
  std::vector<std::string> warnings;
  const Assembly assembly = readAssembly(file, warnings);
  CHECK(assembly.parts.size() == 4096);
  CHECK(assembly.meshes.size() == 1);
}

TEST_CASE("messages quote little of a file, and no control characters") {
  const ScratchFolder folder;
  const std::string odd = "\x1b[2J\x07\xc2\x9b\xff\r", longWord(100'000, 'x');
  const std::string square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const std::string& word : {odd, longWord}) {
    for (const auto& [name, content] :
         {std::pair{"a.obj", "v " + word + " 0 0\n" + square}, std::pair{"a.stl", "solid\n" + word + "\n"},
          std::pair{"a.off", "OFF\n" + word + "\n"}, std::pair{"a.ply", "ply\nformat " + word + "\nend_header\n"},
          std::pair{"a.gltf", "{" + word}, std::pair{"a.dae", "<" + word}, std::pair{"a.x", word}}) {
      CAPTURE(name);
      const std::string message = refusalOf(folder.write(name, content));
      CHECK(isPrintable(message));
      CHECK(message.size() < 1000);
    }
    for (const std::string& content : {word, "{\"" + word + "\": 1}", "{\"" + word + "\": 1, \"" + word + "\": 2}",
                                       R"({"format": "cyber-radar-queries-1", "meshes": [")" +
                                           (word == odd ? "\\u001b\\u009b" : word) + ".obj\"]}"}) {
      CAPTURE(content.substr(0, 80));
      const std::string message = refusalOfQueries(folder.write("q.json", content));
      CHECK(isPrintable(message));
      CHECK(message.size() < 3000);
    }
  }
}

TEST_CASE("JSON that is nested without end is refused") {
  const ScratchFolder folder;
  const std::string open(1'000'000, '['), close(1'000'000, ']');
  CHECK_THAT(refusalOfQueries(folder.write("q.json", "{\"format\": " + open + close + "}")),
             Contains("expected at most 100 levels"));
}
