#include "scene/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/box_tree.h"
#include "scene/parallel.h"
#include "scene/scene.h"

namespace radar {

namespace {

// Searches were slower with leaves of one triangle, and of four.
constexpr uint32_t kLeafTriangles = 2;
// Larger nodes have no slab along their normal: they are rarely flat, and each level costs a pass over all vertices.
constexpr uint32_t kSlabTriangles = 1024;
constexpr size_t kChunk = 4096;

// A tree is built anew once refitting has made its cost this many times that after it was built.
constexpr double kRebuildAt = 2.0;

using Point = std::array<float, 3>;

double halfArea(const FloatBox& box) {
  const double x = double(box.hi[0]) - box.lo[0], y = double(box.hi[1]) - box.lo[1], z = double(box.hi[2]) - box.lo[2];
  return x * y + y * z + z * x;
}

// The nodes that a random line through the root meets, by the areas of their boxes.
double cost(const std::vector<BoxTree::Node>& nodes) {
  double sum = 0;
  for (const BoxTree::Node& node : nodes) sum += halfArea(node.box);
  return sum / std::max(halfArea(nodes[0].box), std::numeric_limits<double>::min());
}

class Builder {
 public:
  explicit Builder(const Mesh& mesh) : mesh_(mesh) {}

  MeshTree build() const {
    BoxTree tree = buildBoxTree(boxesOfTriangles(), kLeafTriangles);
    MeshTree out;
    out.order = std::move(tree.order);
    out.depth = tree.depth;
    out.builtCost = cost(tree.nodes);
    out.nodes.resize(tree.nodes.size());
    out.below.resize(tree.nodes.size());
    out.corners.resize(9 * out.order.size() + MeshTree::kPadding);
    fillAll(out, tree.nodes);
    for (size_t i = out.nodes.size(); i-- > 0;) {  // children come after their parents
      const BoxTree::Node& node = tree.nodes[i];
      if (node.child == 0) continue;
      out.below[i].least = std::min(out.below[node.child].least, out.below[node.child + 1].least);
    }
    return out;
  }

  void refit(MeshTree& tree) const {
    const std::vector<FloatBox> boxes = boxesOfTriangles();
    std::vector<BoxTree::Node> nodes(tree.nodes.size());
    for (size_t i = nodes.size(); i-- > 0;) {  // children come after their parents
      const uint32_t link = tree.nodes[i].link;
      BoxTree::Node& node = nodes[i];
      node = {{}, tree.below[i].first, tree.below[i].count, (link & gpu::kLinkLeaf) != 0 ? 0 : link};
      if (node.child != 0) {
        node.box = around(nodes[node.child].box, nodes[node.child + 1].box);
      } else {
        node.box = boxes[tree.order[node.first]];
        for (uint32_t k = 1; k < node.count; ++k) node.box = around(node.box, boxes[tree.order[node.first + k]]);
      }
    }
    if (cost(nodes) <= kRebuildAt * tree.builtCost) {
      fillAll(tree, nodes);
    } else {
      tree = build();
    }
  }

 private:
  std::vector<FloatBox> boxesOfTriangles() const {
    std::vector<FloatBox> boxes(mesh_.triangleCount());
    parallelFor(boxes.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      for (size_t t = first; t < last; ++t) boxes[t] = boxOf(static_cast<uint32_t>(t));
    });
    return boxes;
  }

  // Writes the nodes and their ranges, but not the least triangle below inner nodes.
  void fillAll(MeshTree& tree, const std::vector<BoxTree::Node>& from) const {
    parallelFor(from.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) fill(tree, from[i], i);
    });
  }

  Point corner(uint32_t triangle, int i) const {
    const uint32_t vertex = mesh_.indices[3 * size_t{triangle} + i];
    return {mesh_.normalised(vertex, 0), mesh_.normalised(vertex, 1), mesh_.normalised(vertex, 2)};
  }

  FloatBox boxOf(uint32_t triangle) const {
    FloatBox box{corner(triangle, 0), corner(triangle, 0)};
    for (int i = 1; i < 3; ++i) {
      const Point p = corner(triangle, i);
      for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::min(box.lo[k], p[k]);
        box.hi[k] = std::max(box.hi[k], p[k]);
      }
    }
    return box;
  }

  void fill(MeshTree& tree, const BoxTree::Node& from, size_t i) const {
    gpu::MeshNode& node = tree.nodes[i];
    fitBox(from.box, node.centre, node.halfExtent);
    node.normal[0] = node.normal[1] = node.normal[2] = node.slabMiddle = node.slabHalf = 0;
    if (from.child == 0) {
      node.link = gpu::kLinkLeaf | (from.count > 1 ? gpu::kLinkPair : 0) | from.first;
      const auto first = tree.order.begin() + from.first;
      tree.below[i] = {from.first, from.count, *std::min_element(first, first + from.count)};
      float* out = &tree.corners[9 * size_t{from.first}];
      for (uint32_t k = 0; k < from.count; ++k) {
        for (int c = 0; c < 3; ++c) out = std::ranges::copy(corner(first[k], c), out).out;
      }
    } else {
      node.link = from.child;
      tree.below[i].first = from.first;
      tree.below[i].count = from.count;
    }
    if (from.count <= kSlabTriangles) fitSlab(tree, from, node);
  }

  // The slab along the triangles' mean normal. Any normal would be valid; this one gives a thin slab.
  void fitSlab(const MeshTree& tree, const BoxTree::Node& from, gpu::MeshNode& node) const {
    Vector sum{};
    for (uint32_t place = from.first; place < from.first + from.count; ++place) {
      const uint32_t triangle = tree.order[place];
      const Point a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
      for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        sum[k] += (double(b[i]) - a[i]) * (double(c[j]) - a[j]) - (double(b[j]) - a[j]) * (double(c[i]) - a[i]);
      }
    }
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    if (!(length > 0)) return;  // a slab whose normal, middle and half extent are 0 holds every vertex
    for (int k = 0; k < 3; ++k) {
      // A device may flush a subnormal number in one use, but not in another.
      const auto component = static_cast<float>(sum[k] / length);
      node.normal[k] = std::abs(component) < std::numeric_limits<float>::min() ? 0 : component;
    }
    double least = std::numeric_limits<double>::max(), most = -least;
    for (uint32_t place = from.first; place < from.first + from.count; ++place) {
      for (int i = 0; i < 3; ++i) {
        const Point p = corner(tree.order[place], i);
        const double at = double(node.normal[0]) * p[0] + double(node.normal[1]) * p[1] + double(node.normal[2]) * p[2];
        least = std::min(least, at);
        most = std::max(most, at);
      }
    }
    node.slabMiddle = static_cast<float>(0.5 * (least + most));
    // Rounding errors of the sums are at most 2^-51 of coordinates below 4.
    const double half = std::max(most - node.slabMiddle, node.slabMiddle - least) + 0x1p-48;
    node.slabHalf = nextAbove(static_cast<float>(half));
  }

  const Mesh& mesh_;
};

}  // namespace

MeshTree buildMeshTree(const Mesh& mesh) {
  return Builder(mesh).build();
}

void refitMeshTree(const Mesh& mesh, MeshTree& tree) {
  Builder(mesh).refit(tree);
}

}  // namespace radar
