// Meshes read from a host's buffers, in the formats that renderers use.
#include <cmath>

#include "embed/on_device.h"
#include "radar/host.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using test::append;
using test::OnDevice;

std::vector<float> positionsOf(const Scene& scene, MeshId mesh) {
  const auto positions = scene.mesh(mesh).positions;
  return {positions.begin(), positions.end()};
}

std::vector<uint32_t> indicesOf(const Scene& scene, MeshId mesh) {
  const auto indices = scene.mesh(mesh).indices;
  return {indices.begin(), indices.end()};
}

}  // namespace

TEST_CASE("interleaved float vertices and 16-bit or 32-bit indices are read at their offsets") {
  std::vector<std::byte> vertices(20), small(6), large(4);  // padding before the data
  append<float>(vertices, {1, 2, 3, /* a normal */ 9, 9, 4, 5, 6, 9, 9, 7, 8, 9.5f, 9, 9, -1, -2, -3});
  append<uint16_t>(small, {2, 1, 0, 3, 2, 1});
  append<uint32_t>(large, {2, 1, 0, 3, 2, 1});
  const OnDevice positions(vertices), indices16(small), indices32(large);
  HostMesh mesh{.positions = {.buffer = positions.get(), .first = 20, .stride = 20},
                .vertexCount = 4,
                .indices = indices16.get(),
                .firstIndex = 6,
                .indexType = VK_INDEX_TYPE_UINT16,
                .indexCount = 6};
  Scene scene;
  const MeshId first = addMesh(scene, test::device(), mesh);
  CHECK(positionsOf(scene, first) == std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9.5f, -1, -2, -3});
  CHECK(indicesOf(scene, first) == std::vector<uint32_t>{2, 1, 0, 3, 2, 1});
  mesh.indices = indices32.get();
  mesh.firstIndex = 4;
  mesh.indexType = VK_INDEX_TYPE_UINT32;
  CHECK(indicesOf(scene, addMesh(scene, test::device(), mesh)) == std::vector<uint32_t>{2, 1, 0, 3, 2, 1});
  // Without indices, every three vertices form a triangle.
  mesh.indices = VK_NULL_HANDLE;
  mesh.vertexCount = 3;
  CHECK(indicesOf(scene, addMesh(scene, test::device(), mesh)) == std::vector<uint32_t>{0, 1, 2});
}

TEST_CASE("meshes that share a host's buffer keep only the vertices that their triangles use") {
  // 100,000 vertices, of which each mesh uses four, far apart.
  constexpr uint32_t kVertices = 100'000;
  std::vector<std::byte> vertices, corners;
  for (uint32_t v = 0; v < kVertices; ++v) append<float>(vertices, {float(v), float(v % 7), v == 5 ? NAN : 1});
  append<uint32_t>(corners, {90'000, 7, 30'000, 30'000, 7, 99'999, 0, 1, 3, 3, 1, 4});
  const OnDevice positions(vertices), indices(corners);
  HostMesh mesh{
      .positions = {.buffer = positions.get()}, .vertexCount = kVertices, .indices = indices.get(), .indexCount = 6};
  Scene scene;
  const MeshId far = addMesh(scene, test::device(), mesh);
  CHECK(positionsOf(scene, far) == std::vector<float>{7, 0, 1, 30'000, 5, 1, 90'000, 1, 1, 99'999, 4, 1});
  CHECK(indicesOf(scene, far) == std::vector<uint32_t>{2, 0, 1, 1, 0, 3});
  mesh.firstIndex = 24;
  const MeshId near = addMesh(scene, test::device(), mesh);
  CHECK(positionsOf(scene, near) == std::vector<float>{0, 0, 1, 1, 1, 1, 3, 3, 1, 4, 4, 1});
  CHECK(indicesOf(scene, near) == std::vector<uint32_t>{0, 1, 2, 2, 1, 3});
  // A host that deforms a mesh writes a range of vertices.
  mesh.bounds = Bounds{{0, 0, 0}, {10, 10, 10}};
  const MeshId deforms = addMesh(scene, test::device(), mesh);
  CHECK(positionsOf(scene, deforms) == std::vector<float>{0, 0, 1, 1, 1, 1, 2, 2, 1, 3, 3, 1, 4, 4, 1});
  CHECK(indicesOf(scene, deforms) == std::vector<uint32_t>{0, 1, 3, 3, 1, 4});
}

TEST_CASE("16-bit positions are read as a vertex shader would see them") {
  std::vector<std::byte> half, snorm, unorm;
  // In half precision: 1, -2, 65504; the smallest normal and subnormal numbers and 1/3; -0, 0 and pi; each with a
  // fourth component.
  append<uint16_t>(half, {0x3c00, 0xc000, 0x7bff, 0, 0x0400, 0x0001, 0x3555, 0, 0x8000, 0x0000, 0x4248, 0});
  append<int16_t>(snorm, {32767, -32767, -32768, 0, 1, -1, 0, 0, 16384, 0, 5, 0});
  append<uint16_t>(unorm, {65535, 0, 32768, 1, 2, 3, 4, 5, 6});
  const OnDevice a(half), b(snorm), c(unorm);
  Scene scene;
  const auto read = [&](const OnDevice& buffer, VkFormat format, VkDeviceSize stride) {
    return positionsOf(
        scene, addMesh(scene, test::device(),
                       {.positions = {.buffer = buffer.get(), .stride = stride, .format = format}, .vertexCount = 3}));
  };
  CHECK(read(a, VK_FORMAT_R16G16B16A16_SFLOAT, 8) ==
        std::vector<float>{1, -2, 65504, 0x1p-14f, 0x1p-24f, 0x1.554p-2f, -0.0f, 0, 3.140625f});
  CHECK(read(b, VK_FORMAT_R16G16B16A16_SNORM, 8) ==
        std::vector<float>{1, -1, -1, 1 / 32767.0f, -1 / 32767.0f, 0, 16384 / 32767.0f, 0, 5 / 32767.0f});
  CHECK(read(c, VK_FORMAT_R16G16B16_UNORM, 6) == std::vector<float>{1, 0, 32768 / 65535.0f, 1 / 65535.0f, 2 / 65535.0f,
                                                                    3 / 65535.0f, 4 / 65535.0f, 5 / 65535.0f,
                                                                    6 / 65535.0f});
}

TEST_CASE("addMesh refuses a host's mesh that cannot be read and names the wrong member") {
  std::vector<std::byte> bytes;
  append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, NAN});
  append<uint32_t>(bytes, {0, 1, 3});
  const OnDevice buffer(bytes);
  Scene scene;
  const auto refused = [&](HostMesh mesh, const char* why) {
    mesh.positions.buffer = buffer.get();
    CHECK_THROWS_WITH(addMesh(scene, test::device(), mesh), test::Contains(why));
  };
  refused({.positions = {.format = VK_FORMAT_R8G8B8_UNORM}, .vertexCount = 3}, "addMesh: positions: format: expected");
  refused({.positions = {.stride = 8}, .vertexCount = 3}, "positions: stride: expected at least 12 bytes, got 8");
  refused({.vertexCount = 0}, "at least one triangle");
  CHECK_THROWS_WITH(addMesh(scene, test::device(), {.vertexCount = 3}), test::Contains("positions: expected a buffer"));
  refused({.vertexCount = 3, .indices = buffer.get(), .indexType = VK_INDEX_TYPE_UINT8_EXT, .indexCount = 3},
          "addMesh: indexType: expected 16 or 32 bits");
  refused({.vertexCount = 3}, "finite");
  refused({.vertexCount = 2, .indices = buffer.get(), .firstIndex = 36, .indexCount = 3}, "refers to vertex 3 of 2");
  CHECK(scene.meshLimit() == 0);
}
