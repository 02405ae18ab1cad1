// The tree over a mesh's triangles: every triangle is in one leaf, and boxes and slabs contain all triangles below
// them, in exact arithmetic.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "exact/dyadic.h"
#include "scene/box_tree.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using exact::Dyadic;

Dyadic magnitude(const Dyadic& x) {
  return x.sign() < 0 ? Dyadic(0.0) - x : x;
}

bool isWithin(const Dyadic& offset, float most) {
  return (Dyadic(most) - magnitude(offset)).sign() >= 0;
}

bool boxHolds(const gpu::MeshNode& node, const std::array<float, 3>& q) {
  for (int k = 0; k < 3; ++k) {
    if (!isWithin(Dyadic(q[k]) - Dyadic(node.centre[k]), node.halfExtent[k])) return false;
  }
  return true;
}

bool slabHolds(const gpu::MeshNode& node, const std::array<float, 3>& q) {
  Dyadic at = Dyadic(0.0) - Dyadic(node.slabMiddle);
  for (int k = 0; k < 3; ++k) at = at + Dyadic(node.normal[k]) * Dyadic(q[k]);
  return isWithin(at, node.slabHalf);
}

bool hasSlab(const gpu::MeshNode& node) {
  return node.normal[0] != 0 || node.normal[1] != 0 || node.normal[2] != 0;
}

struct MeshInScene {
  explicit MeshInScene(const tools::MeshData& data)
      : mesh(scene.impl().meshes[scene.addMesh(data.positions, data.indices)]) {}
  Scene scene;
  const Mesh& mesh;
};

std::array<float, 3> corner(const Mesh& mesh, uint32_t triangle, int i) {
  const uint32_t vertex = mesh.indices[3 * size_t{triangle} + i];
  return {mesh.normalised(vertex, 0), mesh.normalised(vertex, 1), mesh.normalised(vertex, 2)};
}

// Walks a tree and checks that every node contains the triangles below it.
struct Walk {
  const Mesh& mesh;
  std::vector<uint32_t> places = std::vector<uint32_t>(mesh.triangleCount());  // how often a leaf holds each place
  uint32_t depth = 0;
  size_t nodes = 0;

  // Returns the lowest id of a triangle below.
  uint32_t walk(uint32_t at, uint32_t level) {
    ++nodes;
    depth = std::max(depth, level);
    const gpu::MeshNode& node = mesh.tree.nodes.at(at);
    const MeshTree::Below& below = mesh.tree.below.at(at);
    if (below.count == 0 || below.first + below.count > mesh.triangleCount()) FAIL("node " << at << " names no places");
    checkVertices(at, node, below);
    uint32_t least;
    if ((node.link & gpu::kLinkLeaf) != 0) {
      const uint32_t count = (node.link & gpu::kLinkPair) != 0 ? 2 : 1, first = node.link & gpu::kLinkItem;
      if (below.first != first || below.count != count) FAIL("leaf " << at << " and its list differ");
      least = mesh.tree.order[first];
      for (uint32_t place = first; place < first + count; ++place) {
        ++places[place];
        least = std::min(least, mesh.tree.order[place]);
      }
    } else {
      if (node.link <= at) FAIL("the children of node " << at << " stand before it");
      const MeshTree::Below &left = mesh.tree.below.at(node.link), &right = mesh.tree.below.at(node.link + 1);
      if (left.first != below.first || right.first != left.first + left.count ||
          left.count + right.count != below.count) {
        FAIL("the children of node " << at << " do not share its triangles");
      }
      least = std::min(walk(node.link, level + 1), walk(node.link + 1, level + 1));
    }
    if (below.least != least) FAIL("node " << at << " has " << below.least << " for its least, not " << least);
    return least;
  }

  void checkVertices(uint32_t at, const gpu::MeshNode& node, const MeshTree::Below& below) const {
    for (uint32_t place = below.first; place < below.first + below.count; ++place) {
      for (int i = 0; i < 3; ++i) {
        const std::array<float, 3> q = corner(mesh, mesh.tree.order[place], i);
        if (!boxHolds(node, q)) FAIL("the box of node " << at << " leaves out a corner of place " << place);
        if (!slabHolds(node, q)) FAIL("the slab of node " << at << " leaves out a corner of place " << place);
      }
    }
  }
};

void checkTree(const Mesh& mesh) {
  const uint32_t count = mesh.triangleCount();
  REQUIRE(mesh.tree.order.size() == count);
  auto sorted = mesh.tree.order;
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t i = 0; i < count; ++i) REQUIRE(sorted[i] == i);
  Walk walk{mesh};
  CHECK(walk.walk(0, 1) == 0);
  CHECK(walk.nodes == mesh.tree.nodes.size());
  CHECK(walk.nodes == mesh.tree.below.size());
  CHECK(walk.depth == mesh.tree.depth);
  CHECK(std::all_of(walk.places.begin(), walk.places.end(), [](uint32_t times) { return times == 1; }));
  for (const uint32_t vertex : mesh.indices) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(mesh.normalised(vertex, k)) < 2)) FAIL("vertex " << vertex << " is not normalised");
    }
  }
}

tools::MeshData soupOf(std::initializer_list<float> corners, size_t times) {
  tools::MeshData mesh;
  for (size_t i = 0; i < times; ++i) mesh.positions.insert(mesh.positions.end(), corners);
  for (uint32_t i = 0; i < mesh.positions.size() / 3; ++i) mesh.indices.push_back(i);
  return mesh;
}

}  // namespace

TEST_CASE("a mesh's tree has every triangle in one leaf, and every node contains the triangles below it") {
  std::vector<tools::MeshData> meshes{tools::makeBox({1, 2, 3}), tools::makeTorus(3, 1, 20, 12),
                                      tools::makeHook(3, 1, 0.5, 0.2), tools::makeUvSphere(20, 31)};
  tools::Random random(9);
  for (const tools::Soup soup : tools::kSoups) {
    for (const uint32_t triangles : {1u, 2u, 3u, 63u, 64u, 65u, 500u}) {
      meshes.push_back(tools::makeSoup(soup, triangles, random));
    }
  }
  for (size_t i = 0; i < meshes.size(); ++i) {
    CAPTURE(i, meshes[i].triangleCount());
    checkTree(MeshInScene(meshes[i]).mesh);
  }
}

TEST_CASE("equal triangles and triangles that are points make a balanced tree") {
  for (const size_t times : {1u, 2u, 3u, 257u}) {
    for (const tools::MeshData& mesh :
         {soupOf({0, 0, 0, 1, 0, 0, 0, 1, 0}, times), soupOf({5, 5, 5, 5, 5, 5, 5, 5, 5}, times),
          soupOf({0, 0, 0, 0, 0, 0, 0, 0, 0}, times), soupOf({1e-44f, 0, 0, 0, 1e-44f, 0, 0, 0, 1e-44f}, times),
          soupOf({3e38f, 0, 0, -3e38f, 1, 0, 0, 3e38f, 1e-38f}, times)}) {
      CAPTURE(times, mesh.positions[0], mesh.positions[1]);
      const MeshInScene placed(mesh);
      checkTree(placed.mesh);
      CHECK(placed.mesh.tree.depth == 1 + static_cast<uint32_t>(std::ceil(std::log2((times + 1) / 2))));
    }
  }
}

TEST_CASE("neighbouring triangles of every size make a valid tree") {
  tools::MeshData mesh;
  for (int exponent = -140; exponent <= 120; ++exponent) {
    const float at = std::ldexp(1.0f, exponent);
    mesh.positions.insert(mesh.positions.end(), {at, 0, 0, 1.5f * at, at, 0, at, 0, 0.25f * at});
  }
  for (uint32_t i = 0; i < mesh.positions.size() / 3; ++i) mesh.indices.push_back(i);
  checkTree(MeshInScene(mesh).mesh);
}

TEST_CASE("nodes of up to 1024 coplanar triangles have a thin slab, also in a tilted plane") {
  // A tilted plane of 40 x 40 cells.
  tools::MeshData plane;
  for (int y = 0; y <= 40; ++y) {
    for (int x = 0; x <= 40; ++x) {
      const auto u = static_cast<float>(x) / 8, v = static_cast<float>(y) / 8;
      plane.positions.insert(plane.positions.end(), {u, v, 0.5f * u - 0.25f * v});
    }
  }
  for (uint32_t y = 0; y < 40; ++y) {
    for (uint32_t x = 0; x < 40; ++x) {
      const uint32_t i = 41 * y + x;
      plane.indices.insert(plane.indices.end(), {i, i + 1, i + 42, i, i + 42, i + 41});
    }
  }
  const MeshInScene placed(plane);
  checkTree(placed.mesh);
  size_t slabs = 0;
  for (size_t i = 0; i < placed.mesh.tree.nodes.size(); ++i) {
    const gpu::MeshNode& node = placed.mesh.tree.nodes[i];
    CHECK(hasSlab(node) == (placed.mesh.tree.below[i].count <= 1024));
    if (!hasSlab(node)) continue;
    ++slabs;
    CHECK(node.slabHalf < 1e-6f);
    CHECK(std::hypot(node.normal[0], node.normal[1], node.normal[2]) == Approx(1));
  }
  CHECK(slabs > 1000);
}

TEST_CASE("a node's box is the smallest around its triangles, up to rounding") {
  const MeshInScene placed(tools::makeTorus(3, 1, 40, 20));
  const Mesh& mesh = placed.mesh;
  for (size_t i = 0; i < mesh.tree.nodes.size(); ++i) {
    const MeshTree::Below& below = mesh.tree.below[i];
    std::array<float, 3> lo{4, 4, 4}, hi{-4, -4, -4};
    for (uint32_t place = below.first; place < below.first + below.count; ++place) {
      for (int c = 0; c < 3; ++c) {
        const std::array<float, 3> q = corner(mesh, mesh.tree.order[place], c);
        for (int k = 0; k < 3; ++k) {
          lo[k] = std::min(lo[k], q[k]);
          hi[k] = std::max(hi[k], q[k]);
        }
      }
    }
    for (int k = 0; k < 3; ++k) {
      const double half = 0.5 * (double(hi[k]) - lo[k]);
      if (mesh.tree.nodes[i].halfExtent[k] > half + 1e-6) FAIL("the box of node " << i << " is too large");
    }
  }
}

TEST_CASE("equal meshes have equal trees, also if these are built on several threads") {
  const tools::MeshData sphere = tools::makeUvSphere(200, 200);
  const MeshInScene first(sphere), second(sphere);
  const MeshTree &p = first.mesh.tree, &q = second.mesh.tree;
  REQUIRE(p.nodes.size() == q.nodes.size());
  CHECK(std::memcmp(p.nodes.data(), q.nodes.data(), p.nodes.size() * sizeof(gpu::MeshNode)) == 0);
  CHECK(p.order == q.order);
  CHECK(std::memcmp(p.below.data(), q.below.data(), p.below.size() * sizeof(MeshTree::Below)) == 0);
}

TEST_CASE("a box of centre and half extent contains both of its ends despite rounding") {
  tools::Random random(23);
  for (int i = 0; i < 100'000; ++i) {
    std::array<float, 3> lo, hi;
    for (int k = 0; k < 3; ++k) {
      const double size = std::ldexp(1.0, int(random.below(120)) - 60),
                   away = std::ldexp(1.0, int(random.below(120)) - 60);
      lo[k] = static_cast<float>(random.uniform(-away, away));
      hi[k] = static_cast<float>(lo[k] + random.uniform(0, size));
    }
    gpu::MeshNode node{};
    fitBox({lo, hi}, node.centre, node.halfExtent);
    if (!boxHolds(node, lo) || !boxHolds(node, hi)) FAIL("box " << i);
  }
}

TEST_CASE("moved vertices keep their tree while it serves, and a tree that has become bad is built anew") {
  tools::Random random(12);
  for (const bool scrambles : {false, true}) {
    CAPTURE(scrambles);
    tools::MeshData data = tools::makeTorus(3, 1, 40, 30);
    Scene scene;
    const MeshId id = scene.addMesh(data.positions, data.indices);
    const Mesh& mesh = scene.impl().meshes[id];
    const auto order = mesh.tree.order;
    // Bent a little and far away at another size, or with every vertex in the place of another.
    if (scrambles) {
      for (size_t i = data.positions.size() / 3; i > 1; --i) {
        const size_t other = random.below(static_cast<uint32_t>(i));
        for (size_t k = 0; k < 3; ++k) std::swap(data.positions[3 * (i - 1) + k], data.positions[3 * other + k]);
      }
    } else {
      for (float& c : data.positions) c = 1000 + 300 * (c + 0.05f * static_cast<float>(std::sin(c)));
    }
    scene.setPositions(id, data.positions);
    checkTree(mesh);
    CHECK((mesh.tree.order == order) == !scrambles);
  }
}
