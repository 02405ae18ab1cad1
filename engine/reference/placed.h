// Triangles of one placed mesh, put into the world and turned into the view leaf by leaf, when a search comes by.
#pragma once

#include <vector>

#include "reference/tree.h"
#include "reference/view.h"

namespace radar::reference {

inline constexpr uint32_t kLeafSize = 2;

/// A mesh with its tree. The views are the scene's own memory.
struct TreeMesh {
  MeshView mesh;
  Tree<float> tree;
  Vec extent{};                 ///< largest |coordinate| of a used vertex, per axis
  std::vector<uint32_t> least;  ///< per node: the least triangle in it

  explicit TreeMesh(const MeshView& view);
};

struct PlacedTriangle {
  std::array<Lanes, 3> corners;  ///< in the view
  Lanes lo, hi;                  ///< their box, widened by `error`
  double error;                  ///< bounds what rounding did to each lane of each corner
  double area, areaError;  ///< of the triangle seen along the motion, signed, in lanes 0 and 1; bound on its error
  uint32_t id;
  exact::Triangle world;
};

struct PlacedLeaf {
  uint64_t key = 0;
  uint32_t count = 0;
  std::array<PlacedTriangle, kLeafSize> triangles;
};

/// Places leaves on demand and keeps the last few.
class LeafCache {
 public:
  LeafCache() : leaves_(kLeaves) {}
  /// Forgets what it holds; from now on its leaves are those of `mesh` placed by `pose` in `view`. All must stay.
  void bind(const TreeMesh& mesh, const Pose& pose, const View& view);
  /// Valid until the next call.
  const PlacedLeaf& leaf(uint32_t node);

 private:
  static constexpr uint32_t kLeaves = 128;  // 72 kB: stays in the second-level cache
  void place(PlacedLeaf& leaf, const Tree<float>::Node& node) const;

  std::vector<PlacedLeaf> leaves_;
  uint64_t generation_ = 0;
  const TreeMesh* mesh_ = nullptr;
  const Pose* pose_ = nullptr;
  const View* view_ = nullptr;
};

}  // namespace radar::reference
