// glTF: numbers of all types, extensions, skins and morph targets, against what was written.
#include <cmath>
#include <nlohmann/json.hpp>

#include "mesh_texts.h"
#include "workloads/random.h"

using namespace radar::tools;
using namespace radar::test;
using nlohmann::json;

namespace {

using Point = std::array<double, 3>;

template <class Value>
void appendAs(std::string& bytes, double value) {
  append(bytes, static_cast<Value>(value));
}

size_t appendNumber(std::string& bytes, int type, double value) {
  const size_t before = bytes.size();
  if (type == 5120) appendAs<int8_t>(bytes, value);
  if (type == 5121) appendAs<uint8_t>(bytes, value);
  if (type == 5122) appendAs<int16_t>(bytes, value);
  if (type == 5123) appendAs<uint16_t>(bytes, value);
  if (type == 5125) appendAs<uint32_t>(bytes, value);
  if (type == 5126) appendAs<float>(bytes, value);
  return bytes.size() - before;
}

/// A glTF file in the making.
struct Writer {
  json file{{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", json::array()}}}},
            {"nodes", json::array()},
            {"meshes", json::array()},
            {"accessors", json::array()},
            {"bufferViews", json::array()}};
  std::string bytes;

  size_t addView(const std::string& content, size_t stride = 0) {
    json view{{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}};
    if (stride > 0) view["byteStride"] = stride;
    bytes += content;
    file["bufferViews"].push_back(view);
    return file["bufferViews"].size() - 1;
  }
  size_t addAccessor(const std::vector<double>& values, const char* type, size_t components, int componentType,
                     size_t padding = 0) {
    std::string content;
    size_t stride = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      stride += appendNumber(content, componentType, values[i]);
      if (i % components + 1 < components) continue;
      content.append(padding, '\x7f');
      if (i + 1 < values.size()) stride = 0;
    }
    const size_t view = addView(content, padding > 0 ? stride + padding : 0);
    file["accessors"].push_back({{"bufferView", view},
                                 {"componentType", componentType},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return file["accessors"].size() - 1;
  }
  void addRoot(json node) {
    file["scenes"][0]["nodes"].push_back(file["nodes"].size());
    file["nodes"].push_back(std::move(node));
  }
  std::string glb(size_t jsonMisfit = 0) const {
    json whole = file;
    whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = whole.dump(), result = "glTF";
    while (text.size() % 4 != jsonMisfit) text += ' ';
    append(result, uint32_t(2));
    append(result, static_cast<uint32_t>(28 + text.size() + bytes.size()));
    append(result, static_cast<uint32_t>(text.size()));
    result += "JSON" + text;
    append(result, static_cast<uint32_t>(bytes.size()));
    return result + std::string("BIN\0", 4) + bytes;
  }
};

/// A triangle at z = 0, of floats.
Writer triangle() {
  Writer writer;
  writer.addAccessor({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3, 5126);
  writer.file["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
  writer.addRoot({{"mesh", 0}});
  return writer;
}

std::vector<float> cornersOf(const FileMesh& mesh) {
  std::vector<float> corners;
  for (const uint32_t index : mesh.indices) {
    for (size_t k = 0; k < 3; ++k) corners.push_back(float(mesh.positions[3 * size_t{index} + k] + mesh.base[k]));
  }
  return corners;
}

struct Written {
  std::vector<float> corners;
  Writer writer;
};

/// Nodes of scales and moves by powers of two and whole numbers, so that every product is exact; half of them mirror.
Written anyFile(Random& random) {
  Written result;
  Writer& writer = result.writer;
  std::vector<std::pair<Point, Point>> poses;  // scale and translation of each node, in the file's frame
  const uint32_t nodes = 1 + random.below(5);
  for (uint32_t n = 0; n < nodes; ++n) {
    const int types[] = {5120, 5121, 5122, 5123, 5126};
    const int type = types[random.below(5)];
    const bool isNormalised = type != 5126 && random.oneIn(2);
    const double most = type == 5120 ? 127 : type == 5121 ? 255 : type == 5122 ? 32767 : 65535;
    const size_t count = 3 + random.below(6);
    std::vector<double> stored, decoded;
    for (size_t i = 0; i < 3 * count; ++i) {
      stored.push_back(double(random.below(100)) - (type == 5121 || type == 5123 ? 0 : 50));
    }
    const size_t width = type < 5122 ? 1 : type < 5124 ? 2 : 4;
    const size_t position = writer.addAccessor(stored, "VEC3", 3, type, random.below(3) * width);
    if (isNormalised) writer.file["accessors"][position]["normalized"] = true;
    if (random.oneIn(3)) {  // the second vertex is elsewhere
      std::string index, value;
      append(index, uint16_t(1));
      for (size_t k = 0; k < 3; ++k) appendNumber(value, type, stored[3 + k] = 7 + double(k));
      const size_t where = writer.addView(index), what = writer.addView(value);
      writer.file["accessors"][position]["sparse"] = {{"count", 1},
                                                      {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                                      {"values", {{"bufferView", what}}}};
    }
    for (const double value : stored) decoded.push_back(isNormalised ? double(float(value / most)) : value);
    std::vector<double> indices;
    for (uint32_t i = 3 * (1 + random.below(4)); i > 0; --i) indices.push_back(random.below(uint32_t(count)));
    const int indexTypes[] = {5121, 5123, 5125};
    json primitive{{"attributes", {{"POSITION", position}}}};
    const uint32_t mode = 4 + random.below(3);
    primitive["indices"] = writer.addAccessor(indices, "SCALAR", 1, indexTypes[random.below(3)]);
    if (mode != 4 || random.oneIn(2)) primitive["mode"] = mode;
    writer.file["meshes"].push_back({{"primitives", {primitive}}});

    Point scale, move;
    for (size_t k = 0; k < 3; ++k) {
      scale[k] = (random.oneIn(2) ? -1 : 1) * std::ldexp(1, int(random.below(3)) - 1);
      move[k] = random.below(9);
    }
    json node{{"mesh", n}, {"scale", scale}, {"translation", move}};
    std::vector<Point> instances{{0, 0, 0}};
    if (random.oneIn(3)) {
      instances.push_back({4, 5, double(random.below(9))});
      std::vector<double> list;
      for (const Point& p : instances) list.insert(list.end(), p.begin(), p.end());
      const size_t places = writer.addAccessor(list, "VEC3", 3, 5126);
      node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    }
    if (n > 0 && random.oneIn(2)) {  // below the last one
      writer.file["nodes"].back()["children"] = {n};
      writer.file["nodes"].push_back(node);
      for (size_t k = 0; k < 3; ++k) {
        move[k] = poses.back().second[k] + poses.back().first[k] * move[k];
        scale[k] *= poses.back().first[k];
      }
    } else {
      writer.addRoot(node);
    }
    poses.emplace_back(scale, move);

    const bool isMirrored = scale[0] * scale[1] * scale[2] < 0;
    for (const Point& instance : instances) {
      const auto add = [&](size_t a, size_t b, size_t c) {
        if (isMirrored) std::swap(b, c);
        for (const size_t corner : {a, b, c}) {
          for (size_t k = 0; k < 3; ++k) {
            const double local = decoded[3 * size_t(indices[corner]) + k] + instance[k];
            result.corners.push_back(float(local * scale[k] + move[k]));
          }
        }
      };
      if (mode == 4) {
        for (size_t i = 0; i < indices.size(); i += 3) add(i, i + 1, i + 2);
      }
      for (size_t i = 0; mode == 5 && i + 2 < indices.size(); ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
      for (size_t i = 1; mode == 6 && i + 1 < indices.size(); ++i) add(0, i, i + 1);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a glTF file of any types, strides, modes, sparse numbers, mirrors and instances holds what was written") {
  const ScratchFolder folder;
  Random random(63);
  for (int i = 0; i < 1000; ++i) {
    CAPTURE(i);
    const Written written = anyFile(random);
    const std::vector<float> read = cornersOf(readWhole(folder.write("a.glb", written.writer.glb(random.below(4)))));
    REQUIRE(read.size() == written.corners.size());
    for (size_t k = 0; k < read.size(); ++k) {
      // Where an instance moves a normalised number, the sum is rounded in another order.
      REQUIRE(std::abs(read[k] - written.corners[k]) <= 1e-6 * (1 + std::abs(read[k])));
    }
  }
}

TEST_CASE("a glTF file that requires an unknown extension, or holds compressed buffers only, is refused by its name") {
  const ScratchFolder folder;
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "ANY_thing"}) {
    Writer writer = triangle();
    writer.file["extensionsRequired"] = {"KHR_texture_basisu", name};
    CHECK_THAT(refusalOf(folder.write("a.glb", writer.glb())), Contains("extensionsRequired[1]") && Contains(name));
  }
  Writer draco = triangle();
  draco.file["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = json::object();
  CHECK(readWhole(folder.write("fallback.glb", draco.glb())).triangleCount() == 1);
  draco.file["accessors"][0].erase("bufferView");
  CHECK_THAT(refusalOf(folder.write("a.glb", draco.glb())), Contains("accessors[0]") && Contains("KHR_draco"));
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    json file = triangle().file;
    file["buffers"] = {{{"byteLength", 36}}};
    file["bufferViews"][0]["extensions"][name] = {{"buffer", 0}};
    CHECK_THAT(refusalOf(folder.write("a.gltf", file.dump())), Contains("buffers[0]") && Contains(name));
  }
}

TEST_CASE("default weights of morph targets apply, a node's before its mesh's") {
  const ScratchFolder folder;
  Writer writer = triangle();
  const size_t target = writer.addAccessor({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3", 3, 5126);
  writer.file["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
  writer.file["meshes"][0]["weights"] = {0.5};
  writer.addRoot({{"mesh", 0}, {"weights", {1.0}}});
  CHECK(cornersOf(readWhole(folder.write("a.glb", writer.glb()))) ==
        std::vector<float>{0, 0, 1, 1, 0, 1, 0, 1, 1, 0, 0, 2, 1, 0, 2, 0, 1, 2});
}

TEST_CASE("a skinned mesh stands where its joints are, not where its node is, and joints that mirror turn it") {
  const ScratchFolder folder;
  Writer writer = triangle();
  const size_t joints = writer.addAccessor({0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4, 5121);
  const size_t weights = writer.addAccessor({255, 255, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, "VEC4", 4, 5121);
  writer.file["accessors"][weights]["normalized"] = true;
  auto& attributes = writer.file["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints;
  attributes["WEIGHTS_0"] = weights;
  writer.file["nodes"][0]["translation"] = {100, 0, 0};
  writer.file["nodes"][0]["skin"] = 0;
  writer.addRoot({{"translation", {0, 0, 2}}});
  writer.addRoot({{"translation", {0, 0, 4}}});
  writer.file["skins"] = {{{"joints", {1, 2}}}};
  CHECK(cornersOf(readWhole(folder.write("a.glb", writer.glb()))) == std::vector<float>{0, 0, 3, 1, 0, 2, 0, 1, 4});
  writer.file["nodes"][1]["scale"] = writer.file["nodes"][2]["scale"] = {-1, 1, 1};
  CHECK(cornersOf(readWhole(folder.write("a.glb", writer.glb()))) == std::vector<float>{0, 0, 3, 0, 1, 4, -1, 0, 2});
}

TEST_CASE("damaged glTF files are read or refused") {
  const ScratchFolder folder;
  Random random(5);
  size_t whole = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = anyFile(random).writer.glb();
    for (uint32_t count = 1 + random.below(3); count > 0; --count) {
      const size_t at = random.below(uint32_t(bytes.size()));
      if (random.oneIn(8)) bytes.erase(at, random.below(9));
      bytes[at % bytes.size()] = random.oneIn(2) ? char('0' + random.below(10)) : char(random.below(256));
    }
    try {
      std::vector<std::string> warnings;
      const MeshData mesh = readMesh(folder.write("a.glb", bytes), warnings);
      ++whole;
      for (const uint32_t index : mesh.indices) CHECK(index < mesh.vertexCount());
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(whole > 100);
  CHECK(refused > 100);
}

TEST_CASE("what is wrong in a glTF file is named by its place") {
  const ScratchFolder folder;
  const auto refusal = [&](const char* pointer, const json& value) {
    Writer writer = triangle();
    writer.file[json::json_pointer(pointer)] = value;
    return refusalOf(folder.write("a.glb", writer.glb()));
  };
  CHECK_THAT(refusal("/accessors/0/count", 4), Contains("accessors[0]: expected elements among the view's 36 bytes"));
  CHECK_THAT(refusal("/accessors/0/componentType", 5130), Contains("accessors[0].componentType: expected 5120"));
  CHECK_THAT(refusal("/bufferViews/0/byteLength", 37), Contains("bufferViews[0]: expected bytes among"));
  CHECK_THAT(refusal("/nodes/0/children", json{0}), Contains("scenes[0].nodes[0]: expected a node that has no parent"));
  CHECK_THAT(refusal("/nodes/0/rotation", json{0, 0, 0, 0}), Contains("nodes[0]: expected a finite transform"));
  CHECK_THAT(refusal("/meshes/0/primitives/0/indices", 0), Contains("expected SCALAR"));
  CHECK_THAT(refusal("/asset/version", "3.0"), Contains("asset.version: expected version 2.0"));
  Writer writer = triangle();
  writer.bytes.replace(0, 4, "\xff\xff\xff\xff");
  CHECK_THAT(refusalOf(folder.write("a.glb", writer.glb())),
             Contains("POSITION: expected 3 finite numbers as element 0"));
}
