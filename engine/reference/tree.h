// A bounding-volume tree over boxes: built top down with the surface area heuristic over binned centres, flat nodes.
// I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace radar::reference {

template <class Real>
struct Bounds {
  Real lo[3], hi[3];
};

template <class Real>
class Tree {
 public:
  struct Node {
    Real lo[3];
    uint32_t first;  ///< of a leaf: its first place in order(); of an inner node: its left child, the right one follows
    Real hi[3];
    uint32_t count;  ///< items of a leaf; 0: inner node
  };

  /// Leaves hold at most `leafSize` items.
  void build(std::span<const Bounds<Real>> boxes, uint32_t leafSize);
  /// Fits the nodes to changed boxes of the same items. The tree stays as good as its items stay near.
  void refit(std::span<const Bounds<Real>> boxes);

  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Items, leaf by leaf.
  const std::vector<uint32_t>& order() const { return order_; }
  /// Sum of the nodes' surface areas: grows as refitting spoils the tree.
  double area() const;

 private:
  struct Job;
  void fit(Node& node, std::span<const Bounds<Real>> boxes) const;
  uint32_t split(const Job& job, std::span<const Bounds<Real>> boxes);

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

extern template class Tree<float>;
extern template class Tree<double>;

}  // namespace radar::reference
