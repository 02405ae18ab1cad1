// Meshes that a host deforms and objects that it moves on the device: answers equal those of a scene with the same
// geometry.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "embed/host_format.h"
#include "embed/host_world.h"
#include "embed/on_device_scene.h"
#include "embed/renderer.h"
#include "embed/written_queries.h"
#include "exact/dyadic.h"
#include "radar/recorder.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "support/exact_placement.h"
#include "support/small_scenes.h"
#include "workloads/hard_cases.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using namespace test;

/// The vertices and nodes of a deformed mesh, read back from the device.
struct DeformedCopy {
  DeformedCopy(const Scene& scene, const DeformedMesh& deformed) {
    const OnDeviceScene there(scene, {.meshes = {&deformed, 1}});
    const GpuScene::Buffers& buffers = there.copy.buffers();
    const Mesh& mesh = scene.impl().meshes[deformed.mesh];
    const gpu::MeshRecord& record = there.copy.record(deformed.mesh);
    vertices = test::elementsOf(buffers.vertices, record.firstVertex, mesh.vertexCount());
    nodes = test::elementsOf(buffers.meshNodes, record.firstNode, mesh.tree.nodes.size());
    firstNode = record.firstNode;
    firstTriangle = record.firstTriangle;
  }

  std::vector<gpu::Vertex> vertices;
  std::vector<gpu::MeshNode> nodes;
  uint32_t firstNode, firstTriangle;
};

/// Whether |sum of normal * q - middle| <= half, in exact arithmetic.
bool isBetween(const float (&normal)[3], const std::array<float, 3>& q, float middle, float half) {
  using exact::Dyadic;
  Dyadic at = Dyadic(0.0) - Dyadic(middle);
  for (size_t k = 0; k < 3; ++k) at = at + Dyadic(normal[k]) * Dyadic(q[k]);
  return (Dyadic(half) - at).sign() >= 0 && (Dyadic(half) + at).sign() >= 0;
}

/// Checks that every node's box and slab contain the deformed vertices below it and that its link is that of the
/// scene's tree.
void checkNodes(const Mesh& mesh, const DeformedCopy& deformed) {
  constexpr float kAxes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  size_t slabs = 0, thin = 0;
  for (size_t n = 0; n < deformed.nodes.size(); ++n) {
    const gpu::MeshNode& node = deformed.nodes[n];
    const uint32_t link = mesh.tree.nodes[n].link;
    const bool leaf = (link & gpu::kLinkLeaf) != 0;
    if (node.link != link + (leaf ? deformed.firstTriangle : deformed.firstNode)) FAIL("link of node " << n);
    slabs += node.normal[0] != 0 || node.normal[1] != 0 || node.normal[2] != 0;
    thin += leaf && node.slabHalf < 0.3f;
    const MeshTree::Below& below = mesh.tree.below[n];
    for (uint32_t place = below.first; place < below.first + below.count; ++place) {
      for (size_t i = 0; i < 3; ++i) {
        const gpu::Vertex& vertex = deformed.vertices[mesh.indices[3 * size_t{mesh.tree.order[place]} + i]];
        std::array<float, 3> q;
        for (size_t k = 0; k < 3; ++k) q[k] = static_cast<float>((vertex.position[k] - mesh.origin[k]) / mesh.unit);
        for (size_t k = 0; k < 3; ++k) {
          if (!isBetween(kAxes[k], q, node.centre[k], node.halfExtent[k])) {
            FAIL("the box of node " << n << " leaves out a vertex of place " << place);
          }
        }
        if (!isBetween(node.normal, q, node.slabMiddle, node.slabHalf)) {
          FAIL("the slab of node " << n << " leaves out a vertex of place " << place);
        }
      }
    }
  }
  CHECK(slabs > 0);
  CHECK(thin > 0);
}

/// Compares answers over host geometry with a sweeper's, on a scene of each family. `written`: to queries that the host
/// writes.
void compareFamilies(bool written) {
  test::HostWorld world;
  Recorder recorder(test::device(), world.scene, kRoom);
  fuzz::Outcomes all;
  uint32_t seed = 31;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    CAPTURE(family.name, ++seed);
    if (written && (family.ignoresLeaving || (!test::device().doubles() && family.name == "far baked"))) continue;
    const tools::Workload workload = tools::hardScene(family, seed, 0, kRoom.queries, tools::Company::mixed);
    tools::replaceBy(workload, 0, world.truth);
    test::hide(world, seed, true);
    std::vector<Query> queries = test::queriesOf(workload);
    for (size_t q = 0; q < queries.size(); q += 7) queries[q].anyHit = true;
    const test::Written inBuffer(queries);
    if (written) {
      ask(recorder, inBuffer, world, all);
    } else {
      ask(recorder, queries, world, all);
    }
  }
  CHECK(all.hits > all.answered / 8);
  // With random rest poses every node is as large as the mesh, so capacities may be exceeded.
  CHECK(all.lacking() < all.answered / 20);
  CHECK(all.outOfRange == 0);
}

}  // namespace

TEST_CASE("geometry that a host deforms and moves gives the bits of a scene with the same geometry", "[subgroups]") {
  compareFamilies(false);
}

TEST_CASE("queries that a host writes find the geometry that it deforms and moves, with the bits of a scene with it",
          "[subgroups]") {
  compareFamilies(true);
}

TEST_CASE(
    "every 16-bit position has the same value on the device as when loaded, and every node contains its vertices") {
  const VkFormat format = GENERATE(VK_FORMAT_R16G16B16_SFLOAT, VK_FORMAT_R16G16B16A16_SNORM, VK_FORMAT_R16G16B16_UNORM);
  const uint32_t vertices = 21846;
  const HostPositions positions{
      .first = 3, .stride = format == VK_FORMAT_R16G16B16A16_SNORM ? 8u : 6u, .format = format};
  std::vector<std::byte> bytes(positions.first + positions.stride * vertices);
  std::vector<float> expected;
  for (uint32_t v = 0; v < vertices; ++v) {
    std::byte* at = &bytes[positions.first + positions.stride * v];
    for (uint32_t k = 0; k < 3; ++k) {
      auto bits = static_cast<uint16_t>(std::min(3 * v + k, 0xffffu));
      if (format == VK_FORMAT_R16G16B16_SFLOAT && (bits & 0x7c00) == 0x7c00)
        bits &= 0x83ff;  // neither infinite nor NaN
      std::memcpy(at + 2 * k, &bits, 2);
      expected.push_back(HostFormat(format).load(at, static_cast<int>(k)));
    }
  }
  Scene scene;
  std::vector<uint32_t> indices(3 * (vertices / 3));
  for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  const MeshId mesh = scene.addMesh(std::vector<float>(expected.size()), indices, boundsOf(expected));

  const OnDevice buffer(bytes);
  HostPositions there = positions;
  there.buffer = buffer.get();
  const DeformedCopy deformed(scene, {mesh, there});
  for (size_t i = 0; i < expected.size(); ++i) {
    const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
    if (bits(deformed.vertices[i / 3].position[i % 3]) != bits(expected[i])) FAIL("vertex " << i / 3);
  }
  checkNodes(scene.impl().meshes[mesh], deformed);
}

TEST_CASE("every node of a deformed mesh contains its vertices, however far they are from the rest pose") {
  std::mt19937 random(17);
  for (const tools::MeshData& data :
       {tools::makeTorus(3, 1, 30, 20), tools::makeHook(3, 1, 0.5, 0.2), tools::makeUvSphere(40, 40)}) {
    for (const double away : {0.0, 1000.0}) {
      std::vector<float> rest = data.positions, moved = data.positions;
      for (size_t i = 0; i < rest.size(); ++i) {
        rest[i] = static_cast<float>(rest[i] + away);
        moved[i] = static_cast<float>(rest[i] + 0.3 * (static_cast<double>(random() >> 8) * 0x1p-23 - 1));
      }
      Bounds bounds = boundsOf(rest);
      for (size_t k = 0; k < 3; ++k) {
        bounds.lo[k] -= 0.4;
        bounds.hi[k] += 0.4;
      }
      Scene scene;
      scene.addMesh(data.positions, data.indices);  // shifts the nodes of the next mesh in the buffer
      const MeshId mesh = scene.addMesh(rest, data.indices, bounds);
      const OnDevice buffer = test::bufferOf(moved);
      CAPTURE(data.triangleCount(), away);
      const DeformedCopy deformed(scene, {mesh, {.buffer = buffer.get()}});
      for (size_t k = 0; k < 3; ++k) CHECK(deformed.vertices[0].position[k] == moved[k]);
      checkNodes(scene.impl().meshes[mesh], deformed);
    }
  }
}

TEST_CASE(
    "an object that a host moves is placed according to its transform, within the error that its placement states",
    "[subgroups]") {
  // Exponents of the transforms' scales: ordinary ones, the range of floats, and beyond it.
  const int smallest = GENERATE(-30, -79, -140), largest = std::min(-smallest, 85);
  CAPTURE(smallest);
  tools::Random random(23);
  const auto powerOfTwo = [&](int lowest, int highest) { return std::exp2(random.uniform(lowest, highest)); };
  Scene scene;
  for (uint32_t i = 0; i < 40; ++i) test::addMesh(scene, test::oddMesh(random, i, random.uniform(-20, 20)));
  test::HostFrame frame;
  std::vector<Transform> poses;
  for (uint32_t i = 0; i < 1200; ++i) {
    Transform pose;
    const double scale = powerOfTwo(smallest, largest), away = i % 3 == 0 ? 0 : powerOfTwo(smallest - 10, largest + 25);
    for (double& value : pose.m) value = static_cast<float>(scale * random.uniform(-1, 1));
    // Some poses are flat or nearly flat.
    for (size_t row = 0; row < 3; ++row) pose.m[4 * row + 2] *= i % 5 == 0 ? 0 : i % 5 == 1 ? 0x1p-20 : 1;
    // A flat mesh does not use the last column, so any value may be there.
    const double unused = i % 10 == 8 && i % 3 == 0 && smallest < -30 ? powerOfTwo(smallest, 126) / scale : 1;
    for (size_t row = 0; row < 3; ++row) pose.m[4 * row + 2] = static_cast<float>(pose.m[4 * row + 2] * unused);
    for (size_t row = 0; row < 3; ++row) pose.m[4 * row + 3] = static_cast<float>(random.uniform(-away, away));
    poses.push_back(pose);
    const ObjectId id = scene.addObject({.mesh = i % 40});
    scene.setBounds(id, {{-0x1p120, -0x1p120, -0x1p120}, {0x1p120, 0x1p120, 0x1p120}});
    frame.move(id, pose);
  }
  const OnDeviceScene there(scene, frame.geometry());
  const std::vector<gpu::Placement> placements = test::elementsOf(there.copy.buffers().placements, 0, poses.size());
  const std::vector<gpu::ObjectRecord> records = test::elementsOf(there.copy.buffers().objects, 0, poses.size());
  test::BoundsUsed used;
  size_t inRange = 0;
  for (uint32_t i = 0; i < poses.size(); ++i) {
    CAPTURE(i);
    CHECK(records[i].mesh == i % 40);
    CHECK(std::equal(poses[i].m.begin(), poses[i].m.end(), records[i].pose));
    CHECK(placements[i].mesh == i % 40);
    CHECK(placements[i].mask == ~0u);
    CHECK(placements[i].root == there.copy.record(i % 40).firstNode);
    for (const float* rows : {placements[i].coarse, placements[i].fine, placements[i].inverse}) {
      CHECK(std::all_of(rows, rows + 12, [](float x) { return std::isfinite(x); }));
    }
    CHECK(std::isfinite(placements[i].error + placements[i].size));
    if (!isInRange(placements[i])) continue;
    ++inRange;
    test::checkPlacement(scene.impl().meshes[i % 40], poses[i], placements[i], used);
  }
  CHECK(inRange > (smallest == -30 ? 1100 : smallest == -79 ? 700 : 400));
  CHECK(used.inverse > 0.01);
}
