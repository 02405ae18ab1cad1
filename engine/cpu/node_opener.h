// Splits pairs of nodes of two meshes' trees, one part for each lane.
#pragma once

#include <algorithm>

#include "cpu/node_test.h"

namespace radar::cpu {

inline namespace RADAR_WIDTH {

/// Splits pairs of nodes.
class NodeOpener {
 public:
  /// `matrix`: from A's frame to B's.
  NodeOpener(const Mesh& a, const Mesh& b, const Matrix3& matrix)
      : nodesA_(a.tree.nodes.data()), nodesB_(b.tree.nodes.data()) {
    double scale = 0;
    for (const Vector& row : matrix) scale += norm1(row);
    scale_ = static_cast<float>(std::min(scale / 3, 0x1p100));
  }

  /// The parts of a pair, one in each lane.
  struct Parts {
    NodeLanes a, b;
    unsigned valid;  ///< one bit per part; 0 if it repeats another
  };
  /// Opens nodes that are not both leaves: both, if they are of similar sizes, and the larger by as many levels as
  /// there are lanes for; else the larger alone.
  void open(const gpu::MeshNode& a, const gpu::MeshNode& b, Parts& out) const {
    const bool leafA = isLeaf(a), leafB = isLeaf(b);
    const float sizeA = scale_ * sizeOf(a), sizeB = sizeOf(b);
    if (!leafA && !leafB && sizeA < kSimilar * sizeB && sizeB < kSimilar * sizeA) {
      if (sizeA > sizeB) {
        out.valid = openBoth(nodesA_ + a.link, nodesA_, out.a, nodesB_ + b.link, out.b);
      } else {
        out.valid = openBoth(nodesB_ + b.link, nodesB_, out.b, nodesA_ + a.link, out.a);
      }
    } else if (leafB || (!leafA && sizeA > sizeB)) {
      out.b.fill(&b);
      out.valid = below<kLanes>(nodesA_ + a.link, nodesA_, out.a.data());
    } else {
      out.a.fill(&a);
      out.valid = below<kLanes>(nodesB_ + b.link, nodesB_, out.b.data());
    }
  }

 private:
  // Two nodes whose sizes differ by less than this factor are both opened.
  static constexpr float kSimilar = 4;

  static float sizeOf(const gpu::MeshNode& node) {
    return node.halfExtent[0] + node.halfExtent[1] + node.halfExtent[2];
  }
  /// The nodes below two siblings, `count` with them; a leaf stands for itself, and repeats. Returns which do not.
  template <int count>
  static unsigned below(const gpu::MeshNode* pair, const gpu::MeshNode* nodes, const gpu::MeshNode** out) {
    if constexpr (count == 2) {
      out[0] = pair;
      out[1] = pair + 1;
      return 0b11;
    } else {
      unsigned valid = 0;
      for (int i = 0; i < 2; ++i) {
        if (isLeaf(pair[i])) {
          std::fill_n(out + count / 2 * i, count / 2, pair + i);
          valid |= 1u << (count / 2 * i);
        } else {
          valid |= below<count / 2>(nodes + pair[i].link, nodes, out + count / 2 * i) << (count / 2 * i);
        }
      }
      return valid;
    }
  }
  /// Each of the nodes below two siblings with each of two others.
  static unsigned openBoth(const gpu::MeshNode* large, const gpu::MeshNode* nodes, NodeLanes& ofLarge,
                           const gpu::MeshNode* small, NodeLanes& ofSmall) {
    constexpr int kHalf = kLanes / 2;
    const unsigned valid = below<kHalf>(large, nodes, ofLarge.data());
    for (int i = 0; i < kHalf; ++i) {
      ofLarge[kHalf + i] = ofLarge[i];
      ofSmall[i] = small;
      ofSmall[kHalf + i] = small + 1;
    }
    return valid | valid << kHalf;
  }

  const gpu::MeshNode *nodesA_, *nodesB_;
  float scale_;  // of A's nodes in B's frame
};

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
