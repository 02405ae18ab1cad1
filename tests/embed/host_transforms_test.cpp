// A host's transforms in every layout: shaders read the same matrices as the CPU.
#include <bit>
#include <cmath>
#include <random>

#include "embed/host_transforms.h"
#include "embed/on_device.h"
#include "embed/on_device_scene.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "support/exact_placement.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::execute;
using test::OnDevice;

struct Named {
  const char* name;
  TransformLayout layout;
  size_t floats;  ///< that a transform has
};

const std::vector<Named>& layouts() {
  static const std::vector<Named> all{
      {"rows", kRowMajor, 12},
      {"columns", kColumnMajor, 16},
      {"columns of three", MatrixLayout{4, 12}, 12},
      {"position, quaternion and three scales", QuaternionLayout{}, 10},
      {"scale, position and quaternion", QuaternionLayout{.position = 4, .quaternion = 16, .scale = 0, .scales = 1}, 8},
      {"quaternion and position", QuaternionLayout{.position = 16, .quaternion = 0, .scales = 0}, 7}};
  return all;
}

/// Many transforms of one layout, at an odd stride: of any finite floats that keep a unit box within 2^110.
struct Transforms {
  Transforms(const Named& named, uint32_t count, size_t first, size_t stride) : bytes(first + count * stride) {
    std::mt19937 random(7);
    const auto* turned = std::get_if<QuaternionLayout>(&named.layout);
    for (uint32_t i = 0; i < count; ++i) {
      std::byte* at = &bytes[first + i * stride];
      for (size_t k = 0; k < named.floats; ++k) {
        // Exponents of -149 to 35: three of them are multiplied.
        const uint32_t exponent = i % 4 == 0 ? random() % 163 : 120 + random() % 10;
        uint32_t bits = (random() & 0x807fffffu) | exponent << 23;
        if (random() % 20 == 0) bits &= 0x80000000u;
        std::memcpy(at + 4 * k, &bits, 4);
      }
      if (turned == nullptr || i % 4 == 1) continue;
      // Usually of length 1.
      float q[4];
      std::memcpy(q, at + turned->quaternion, sizeof(q));
      const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
      for (float& part : q) part = length > 0 ? static_cast<float>(part / length) : 0.5f;
      std::memcpy(at + turned->quaternion, q, sizeof(q));
    }
  }
  std::vector<std::byte> bytes;
};

/// The rotation by twice the quaternion's angle, in doubles, for comparison with readTransform.
std::array<double, 3> rotated(const std::array<double, 4>& q, const std::array<double, 3>& p) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> v{q[0], q[1], q[2]}, once = cross(v, p), twice = cross(v, once);
  std::array<double, 3> out;
  for (size_t k = 0; k < 3; ++k) out[k] = p[k] + 2 * (q[3] * once[k] + twice[k]);
  return out;
}

}  // namespace

TEST_CASE("a shader reads the same matrix as readTransform from a transform in any layout, at any offset") {
  const size_t which = GENERATE(range(size_t{0}, size_t{6}));
  const Named& named = layouts()[which];
  CAPTURE(named.name);
  const uint32_t count = 3000;
  const size_t first = which, stride = 4 * named.floats + which;
  const Transforms given(named, count, first, stride);
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  std::vector<ObjectId> objects;
  for (uint32_t i = 0; i < count; ++i) {
    objects.push_back(scene.addObject({mesh, {}, i + 1}));
    scene.setBounds(objects.back(), {{-0x1p120, -0x1p120, -0x1p120}, {0x1p120, 0x1p120, 0x1p120}});
  }
  const OnDevice buffer(given.bytes);
  const MovedObjects moved{
      .transforms = buffer.get(), .first = first, .stride = stride, .objects = objects, .layout = named.layout};
  const test::OnDeviceScene there(scene, {.objects = {&moved, 1}});
  const std::vector<gpu::ObjectRecord> records = test::elementsOf(there.copy.buffers().objects, 0, count);
  const std::vector<gpu::Placement> placements = test::elementsOf(there.copy.buffers().placements, 0, count);
  test::BoundsUsed used;
  uint32_t inRange = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Transform expected = readTransform(&given.bytes[first + i * stride], named.layout);
    for (size_t k = 0; k < 12; ++k) {
      if (std::bit_cast<uint64_t>(records[i].pose[k]) != std::bit_cast<uint64_t>(expected.m[k])) {
        FAIL("transform " << i << ": entry " << k << ": expected " << expected.m[k] << ", got " << records[i].pose[k]);
      }
    }
    CHECK(placements[i].mask == i + 1);
    if (!isInRange(placements[i])) continue;
    ++inRange;
    test::checkPlacement(scene.impl().meshes[mesh], expected, placements[i], used);
  }
  CHECK(inRange > count / 2);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("readTransform turns by the quaternion, after scaling and before moving, and takes columns for columns") {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1; };
  for (int i = 0; i < 200; ++i) {
    float parts[10];
    for (float& part : parts) part = uniform();
    const double length = std::hypot(std::hypot(parts[3], parts[4]), std::hypot(parts[5], parts[6]));
    for (size_t k = 3; k < 7; ++k) parts[k] = static_cast<float>(parts[k] / length);
    const auto* bytes = reinterpret_cast<const std::byte*>(parts);
    const Transform pose = readTransform(bytes, QuaternionLayout{});
    const float p[3] = {uniform(), uniform(), uniform()};
    const std::array<double, 3> found = transformPoint(pose, p);
    std::array<double, 3> expected =
        rotated({parts[3], parts[4], parts[5], parts[6]},
                {double{p[0]} * parts[7], double{p[1]} * parts[8], double{p[2]} * parts[9]});
    for (size_t k = 0; k < 3; ++k) CHECK(found[k] == Approx(expected[k] + parts[k]).margin(1e-6));
  }
  float entries[16];
  for (size_t i = 0; i < 16; ++i) entries[i] = static_cast<float>(i);
  const auto* bytes = reinterpret_cast<const std::byte*>(entries);
  CHECK(readTransform(bytes, kRowMajor) == Transform{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
  CHECK(readTransform(bytes, kColumnMajor) == Transform{{0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14}});
}

TEST_CASE("a recording refuses transforms that overlap, or that have another number of scales, and says which") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  const ObjectId object = scene.addObject({.mesh = mesh});
  scene.setBounds(object, {{-9, -9, -9}, {9, 9, 9}});
  const OnDevice buffer(std::vector<std::byte>(256));
  Recorder recorder(test::device(), scene);
  const std::vector<Query> queries{{.mesh = mesh, .direction = {0, 0, 1}, .distance = 1}};
  const auto refused = [&](VkDeviceSize stride, const TransformLayout& layout, const char* why) {
    const MovedObjects moved{.transforms = buffer.get(), .stride = stride, .objects = {&object, 1}, .layout = layout};
    CHECK_THROWS_WITH(execute(recorder, queries, {.objects = {&moved, 1}}), test::Contains(why));
  };
  refused(47, kRowMajor, "objects: stride: expected at least 48 bytes, got 47");
  refused(59, kColumnMajor, "objects: stride: expected at least 60 bytes, got 59");
  refused(39, QuaternionLayout{}, "objects: stride: expected at least 40 bytes, got 39");
  refused(31, QuaternionLayout{.scales = 1}, "objects: stride: expected at least 32 bytes, got 31");
  refused(27, QuaternionLayout{.scales = 0}, "objects: stride: expected at least 28 bytes, got 27");
  refused(64, QuaternionLayout{.scales = 2}, "objects: layout: scales: expected 0, 1 or 3, got 2");
  refused(64, QuaternionLayout{.position = 0xffffffffu}, "objects: stride: expected at least 4294967307 bytes");
}
