#include "scene/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scene/scene.h"

namespace radar {

namespace {

struct Range {
  uint32_t node, first, count;
};

struct Builder {
  explicit Builder(const Mesh& m) : mesh(m), middles(m.triangleCount()) {
    for (uint32_t i = 0; i < middles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const float a = at(i, 0, k), b = at(i, 1, k), c = at(i, 2, k);
        middles[i][k] = 0.5f * (std::min({a, b, c}) + std::max({a, b, c}));
      }
    }
  }

  float at(uint32_t triangle, int corner, int axis) const {
    return mesh.recentred[axis][mesh.indices[3 * size_t{triangle} + corner]];
  }

  // Centre and half extents that hold lo and hi whatever the rounding.
  void fit(ClusterNode& node, const uint32_t* triangles, uint32_t count) const {
    for (int k = 0; k < 3; ++k) {
      float lo = std::numeric_limits<float>::max(), hi = -lo;
      for (uint32_t i = 0; i < count; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
          lo = std::min(lo, at(triangles[i], corner, k));
          hi = std::max(hi, at(triangles[i], corner, k));
        }
      }
      node.centre[k] = 0.5f * lo + 0.5f * hi;
      const float half = std::max(hi - node.centre[k], node.centre[k] - lo);
      node.half[k] = std::nextafter(half, std::numeric_limits<float>::max());
    }
  }

  std::array<float, 3> longestEdge(const uint32_t* triangles, uint32_t count) const {
    std::array<float, 3> longest{};
    float best = 0;
    for (uint32_t i = 0; i < count; ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        std::array<float, 3> edge;
        for (int k = 0; k < 3; ++k) edge[k] = at(triangles[i], (corner + 1) % 3, k) - at(triangles[i], corner, k);
        const float squared = edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2];
        if (squared > best) {
          best = squared;
          longest = edge;
        }
      }
    }
    return longest;
  }

  int widest(const uint32_t* triangles, uint32_t count) const {
    int axis = 0;
    float best = -1;
    for (int k = 0; k < 3; ++k) {
      float lo = std::numeric_limits<float>::max(), hi = -lo;
      for (uint32_t i = 0; i < count; ++i) {
        lo = std::min(lo, middles[triangles[i]][k]);
        hi = std::max(hi, middles[triangles[i]][k]);
      }
      if (hi - lo > best) {
        best = hi - lo;
        axis = k;
      }
    }
    return axis;
  }

  const Mesh& mesh;
  std::vector<std::array<float, 3>> middles;
};

}  // namespace

Clusters clustersOf(const Mesh& mesh) {
  const Builder builder(mesh);
  Clusters out;
  out.order.resize(mesh.triangleCount());
  std::iota(out.order.begin(), out.order.end(), 0u);
  out.nodes.emplace_back();
  std::vector<Range> open{{0, 0, mesh.triangleCount()}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    uint32_t* triangles = out.order.data() + range.first;
    ClusterNode node;
    builder.fit(node, triangles, range.count);
    if (range.count <= kClusterTriangles) {
      std::sort(triangles, triangles + range.count);
      node.first = range.first;
      node.count = range.count;
      node.edge = builder.longestEdge(triangles, range.count);
      ++out.leaves;
    } else {
      const int axis = builder.widest(triangles, range.count);
      const uint32_t half = (range.count / 2 + kClusterTriangles - 1) / kClusterTriangles * kClusterTriangles;
      std::nth_element(triangles, triangles + half, triangles + range.count, [&](uint32_t a, uint32_t b) {
        const float x = builder.middles[a][axis], y = builder.middles[b][axis];
        return x < y || (x == y && a < b);
      });
      node.first = static_cast<uint32_t>(out.nodes.size());
      out.nodes.resize(out.nodes.size() + 2);
      open.push_back({node.first + 1, range.first + half, range.count - half});
      open.push_back({node.first, range.first, half});
    }
    out.nodes[range.node] = node;
  }
  return out;
}

}  // namespace radar
