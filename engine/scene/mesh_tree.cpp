#include "scene/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "math/lanes.h"
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

template <class PointAt>
FloatBox boxAround(uint32_t count, const PointAt& pointAt) {
  FourFloats lo = pointAt(0), hi = lo;
  for (uint32_t i = 1; i < count; ++i) {
    const FourFloats next = pointAt(i);
    lo = next < lo ? next : lo;
    hi = next > hi ? next : hi;
  }
  return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

double halfArea(const FloatBox& box) {
  const double x = double(box.hi[0]) - box.lo[0], y = double(box.hi[1]) - box.lo[1], z = double(box.hi[2]) - box.lo[2];
  return x * y + y * z + z * x;
}

// A node of at most kSlabTriangles, and those below it: first to last - 1. Or a larger node alone, which holds such.
struct Part {
  uint32_t node, first, last;
  uint32_t above;  ///< the part of the node above
};

// Fits parts of a tree, one after another. Nothing but its construction throws.
class PartFitter {
 public:
  explicit PartFitter(size_t mostTriangles)
      : boxes_(2 * mostTriangles), sums_(2 * mostTriangles), normals_(mostTriangles) {
    for (std::vector<double>& along : corners_) along.resize(3 * mostTriangles + 1);
  }

  // Returns the box; adds the areas of all nodes.
  FloatBox fit(MeshTree& tree, const Part& part, double& areas) {
    const MeshTree::Below& all = tree.below[part.node];
    load(&tree.corners[9 * size_t{all.first}], all.count);
    const auto forNodes = [&](const auto& work) {
      for (uint32_t i = part.last; i-- > part.first;) work(i, i - part.first);
      work(part.node, static_cast<uint32_t>(boxes_.size() - 1));
    };
    forNodes([&](uint32_t i, uint32_t place) {
      FloatBox& box = boxes_[place];
      Vector& sum = sums_[place];
      uint32_t rest;  // the first triangle whose normal the sum lacks
      gpu::MeshNode& node = tree.nodes[i];
      MeshTree::Below& below = tree.below[i];
      if (isLeaf(node)) {
        const float* const corners = &tree.corners[9 * size_t{below.first}];
        box = boxAround(3 * below.count, [&](uint32_t at) {
          FourFloats corner;
          std::memcpy(&corner, corners + 3 * size_t{at}, sizeof(corner));
          return corner;
        });
        below.least = std::min(tree.order[below.first], tree.order[below.first + below.count - 1]);
        sum = {};
        rest = below.first;
      } else {
        const uint32_t left = node.link - part.first;
        box = around(boxes_[left], boxes_[left + 1]);
        sum = sums_[left];
        rest = tree.below[node.link + 1].first;
        below.least = std::min(tree.below[node.link].least, tree.below[node.link + 1].least);
      }
      areas += halfArea(box);
      fitBox(box, node.centre, node.halfExtent);
      for (uint32_t t = rest - all.first; t < below.first - all.first + below.count; ++t) {
        for (int k = 0; k < 3; ++k) sum[k] += normals_[t][k];
      }
    });
    // One after another, what a node's steps wait for would add up.
    forNodes([&](uint32_t i, uint32_t place) { setNormal(tree.nodes[i], sums_[place]); });
    forNodes(
        [&](uint32_t i, uint32_t) { fitSlab(tree.nodes[i], tree.below[i].first - all.first, tree.below[i].count); });
    return boxes_.back();
  }

 private:
  void load(const float* from, uint32_t triangles) {
    for (uint32_t i = 0; i < 3 * triangles; ++i) {
      for (int k = 0; k < 3; ++k) corners_[k][i] = from[3 * i + k];
    }
    for (uint32_t t = 0; t < triangles; ++t) {
      const uint32_t a = 3 * t, b = a + 1, c = a + 2;
      for (int k = 0; k < 3; ++k) {
        const std::vector<double>&along = corners_[(k + 1) % 3], &across = corners_[(k + 2) % 3];
        normals_[t][k] =
            (along[b] - along[a]) * (across[c] - across[a]) - (across[b] - across[a]) * (along[c] - along[a]);
      }
    }
  }

  // Any normal would be valid; the triangles' mean gives a thin slab. It is 0 if there is none: a slab whose normal,
  // middle and half extent are 0 holds every vertex.
  static void setNormal(gpu::MeshNode& node, const Vector& sum) {
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    for (int k = 0; k < 3; ++k) {
      // A device may flush a subnormal number in one use, but not in another.
      const auto component = static_cast<float>(sum[k] / length);
      node.normal[k] = std::abs(component) >= std::numeric_limits<float>::min() ? component : 0;
    }
  }

  void fitSlab(gpu::MeshNode& node, uint32_t first, uint32_t count) const {
    node.slabMiddle = node.slabHalf = 0;
    if (node.normal[0] == 0 && node.normal[1] == 0 && node.normal[2] == 0) return;
    const auto [least, most] = along(node.normal, 3 * first, 3 * (first + count));
    node.slabMiddle = static_cast<float>(0.5 * (least + most));
    // Rounding errors of the sums are at most 2^-51 of coordinates below 4.
    const double half = std::max(most - node.slabMiddle, node.slabMiddle - least) + 0x1p-48;
    node.slabHalf = nextAbove(static_cast<float>(half));
  }

  // The least and the greatest place of corners along a normal.
  std::pair<double, double> along(const float (&normal)[3], size_t first, size_t last) const {
    const LaneVec<double> n{double{normal[0]}, double{normal[1]}, double{normal[2]}};
    const auto at = [&](size_t i) {
      return n[0] * loaded(&corners_[0][i]) + n[1] * loaded(&corners_[1][i]) + n[2] * loaded(&corners_[2][i]);
    };
    Lanes<double> low = at(first), high = low;
    const auto add = [&](const Lanes<double>& next) {
      low = min(next, low);
      high = max(next, high);
    };
    for (size_t i = first + kLanes; i + kLanes <= last; i += kLanes) add(at(i));
    int lanes = kLanes;
    if (last - first >= kLanes) {
      add(at(last - kLanes));
    } else {
      lanes = static_cast<int>(last - first);  // a triangle
    }
    double least = low[0], most = high[0];
    for (int k = 1; k < kLanes && k < lanes; ++k) {
      least = std::min(least, low[k]);
      most = std::max(most, high[k]);
    }
    return {least, most};
  }

  static Lanes<double> loaded(const double* from) {
    Lanes<double> out;
    std::memcpy(&out, from, sizeof(out));
    return out;
  }

  std::vector<FloatBox> boxes_;                 // of the nodes below the part's, which has the last
  std::vector<Vector> sums_;                    // of their triangles' normals
  std::array<std::vector<double>, 3> corners_;  // by axis
  std::vector<Vector> normals_;                 // of triangles, twice as long as their area
};

// Fits a tree to the corners of its triangles. Nothing but its construction throws.
class Fitter {
 public:
  explicit Fitter(MeshTree& tree) : tree_(tree) {
    listParts();
    boxes_.resize(parts_.size());
    areas_.resize(parts_.size());
    uint32_t most = 0;
    for (const Part& part : parts_) most = std::max(most, isLarge(part) ? 0 : tree.below[part.node].count);
    fitters_.assign(std::min<size_t>(threadCount(0), parts_.size()), PartFitter(most));
  }

  // Returns how many nodes a random line through the root meets, by the areas of their boxes.
  double fit(const Mesh& mesh) {
    parallelFor(tree_.order.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      float* to = &tree_.corners[9 * first];
      for (size_t place = first; place < last; ++place) {
        const uint32_t* const vertices = &mesh.indices[3 * size_t{tree_.order[place]}];
        for (int i = 0; i < 9; ++i) *to++ = mesh.normalised(vertices[i / 3], i % 3);
      }
    });
    parallelFor(parts_.size(), 1, static_cast<unsigned>(fitters_.size()), [&](unsigned worker, size_t i, size_t) {
      areas_[i] = 0;
      boxes_[i] = isLarge(parts_[i]) ? kEmpty : fitters_[worker].fit(tree_, parts_[i], areas_[i]);
    });
    double areas = 0;
    for (size_t i = parts_.size(); i-- > 0;) {
      const Part& part = parts_[i];
      if (isLarge(part)) fitLarge(part.node, boxes_[i], areas_[i]);
      if (i != 0) boxes_[part.above] = around(boxes_[i], boxes_[part.above]);
      areas += areas_[i];
    }
    return areas / std::max(halfArea(boxes_[0]), std::numeric_limits<double>::min());
  }

 private:
  static constexpr float kMost = std::numeric_limits<float>::max();
  static constexpr FloatBox kEmpty{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};

  bool isLarge(const Part& part) const { return tree_.below[part.node].count > kSlabTriangles; }

  // Nodes before those below, left before right.
  void listParts() {
    std::vector<Part> open{{0, 1, static_cast<uint32_t>(tree_.nodes.size()), 0}};
    while (!open.empty()) {
      const Part part = open.back();
      open.pop_back();
      const auto number = static_cast<uint32_t>(parts_.size());
      parts_.push_back(part);
      if (!isLarge(part)) continue;
      const uint32_t left = part.first, right = left + 1;
      const uint32_t middle = isLeaf(tree_.nodes[right]) ? part.last : tree_.nodes[right].link;
      open.push_back({right, middle, part.last, number});
      open.push_back({left, left + 2, middle, number});
    }
  }

  void fitLarge(uint32_t i, const FloatBox& box, double& area) {
    gpu::MeshNode& node = tree_.nodes[i];
    fitBox(box, node.centre, node.halfExtent);
    tree_.below[i].least = std::min(tree_.below[node.link].least, tree_.below[node.link + 1].least);
    area = halfArea(box);
  }

  MeshTree& tree_;
  std::vector<Part> parts_;
  std::vector<FloatBox> boxes_;  // of the parts' nodes
  std::vector<double> areas_;    // the sum for a part
  std::vector<PartFitter> fitters_;
};

// The boxes of a mesh's triangles, for the time of the build, where their corners will be.
std::span<BoxedItem> boxesOfTriangles(const Mesh& mesh, std::span<float> corners) {
  void* memory = corners.data();
  size_t bytes = corners.size_bytes();
  const size_t count = mesh.triangleCount();
  static_assert(alignof(BoxedItem) - __STDCPP_DEFAULT_NEW_ALIGNMENT__ + sizeof(BoxedItem) <=
                (9 + MeshTree::kPadding) * sizeof(float));
  auto* const boxes = static_cast<BoxedItem*>(std::align(alignof(BoxedItem), count * sizeof(BoxedItem), memory, bytes));
  parallelFor(count, kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t t = first; t < last; ++t) {
      const FloatBox box = boxAround(3, [&](uint32_t i) {
        const uint32_t vertex = mesh.indices[3 * t + i];
        return FourFloats{mesh.normalised(vertex, 0), mesh.normalised(vertex, 1), mesh.normalised(vertex, 2)};
      });
      new (&boxes[t]) BoxedItem(box, static_cast<uint32_t>(t));
    }
  });
  return {boxes, count};
}

}  // namespace

MeshTree buildMeshTree(const Mesh& mesh) {
  MeshTree tree;
  tree.corners.resize(9 * size_t{mesh.triangleCount()} + MeshTree::kPadding);
  {
    const std::span<BoxedItem> items = boxesOfTriangles(mesh, tree.corners);
    const BoxTree from = buildBoxTree(items, kLeafTriangles);
    tree.depth = from.depth;
    tree.order.resize(items.size());
    parallelFor(items.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) tree.order[i] = items[i].index();
    });
    tree.nodes.resize(from.nodes.size());
    tree.below.resize(from.nodes.size());
    parallelFor(from.nodes.size(), kChunk, 0, [&](unsigned, size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const BoxTree::Node& node = from.nodes[i];
        tree.below[i] = {node.first, node.count, 0};
        tree.nodes[i] = {.link = node.child != 0 ? node.child
                                                 : gpu::kLinkLeaf | (node.count > 1 ? gpu::kLinkPair : 0) | node.first};
      }
    });
  }
  std::fill_n(tree.corners.end() - MeshTree::kPadding, MeshTree::kPadding, 0.0f);
  tree.builtCost = Fitter(tree).fit(mesh);
  return tree;
}

void refitMeshTree(const Mesh& mesh, MeshTree& tree, const std::function<void()>& move) {
  Fitter fitter(tree);
  move();
  if (fitter.fit(mesh) <= kRebuildAt * tree.builtCost) return;
  try {
    tree = buildMeshTree(mesh);
  } catch (const std::bad_alloc&) {  // it is worse, but right
  }
}

}  // namespace radar
