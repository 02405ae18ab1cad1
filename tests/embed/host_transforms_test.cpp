// A host's transforms in every layout: shaders read the same matrices as the CPU.
#include <bit>
#include <cstring>
#include <random>

#include "embed/on_device.h"
#include "embed/on_device_scene.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "support/exact_placement.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using test::OnDevice;

struct Named {
  const char* name;
  TransformLayout layout;
  size_t floats;  ///< that a transform has
};
const Named kLayouts[] = {{"rows", kRowMajor, 12}, {"columns", kColumnMajor, 16}, {"columns of three", {4, 12}, 12}};

/// Many transforms of one layout, at an odd stride: of any finite floats that keep a unit box within 2^110.
struct Transforms {
  Transforms(const Named& named, uint32_t count, size_t first, size_t stride) : bytes(first + count * stride) {
    std::mt19937 random(7);
    for (uint32_t i = 0; i < count; ++i) {
      std::byte* at = &bytes[first + i * stride];
      for (size_t k = 0; k < named.floats; ++k) {
        const uint32_t exponent = i % 4 == 0 ? random() % 163 : 120 + random() % 10;
        uint32_t bits = (random() & 0x807fffffu) | exponent << 23;
        if (random() % 20 == 0) bits &= 0x80000000u;
        std::memcpy(at + 4 * k, &bits, 4);
      }
    }
  }
  std::vector<std::byte> bytes;
};

Transform transformAt(const std::byte* bytes, const TransformLayout& layout) {
  Transform out;
  for (size_t i = 0; i < 12; ++i) {
    float entry;
    std::memcpy(&entry, bytes + i / 4 * layout.row + i % 4 * layout.column, sizeof(entry));
    out.m[i] = entry;
  }
  return out;
}

}  // namespace

TEST_CASE("a shader reads the same matrix as the CPU from a transform in any layout, at any offset") {
  const size_t which = GENERATE(range(size_t{0}, size_t{3}));
  const Named& named = kLayouts[which];
  CAPTURE(named.name);
  const uint32_t count = 3000;
  const size_t first = which, stride = 4 * named.floats + which;
  const Transforms given(named, count, first, stride);
  Scene scene;
  const MeshId mesh = test::addBox(scene);
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
    const Transform expected = transformAt(&given.bytes[first + i * stride], named.layout);
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
}
