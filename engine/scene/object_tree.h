// The bounding-volume tree over a scene's objects, for the searches on the device and on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/box.h"
#include "math/rounding.h"
#include "radar/scene.h"
#include "scene/changed_pages.h"
#include "scene/large_vector.h"
#include "shaders/shared/interop.h"

namespace radar {

struct BoxTree;

/// An object's world box, its motion and its bounds from setBounds included.
Box objectBox(const Scene::Impl& scene, ObjectId object);

/// Objects that were added, moved or removed.
struct ObjectChanges {
  std::vector<ObjectId> objects;  ///< some perhaps several times
  bool areMany = false;           ///< any object may have changed; `objects` is not used
};

/// Follows a scene. A few changed objects are inserted, removed or refitted one by one, along their paths to the root;
/// if many have changed, the tree is refitted or, if objects were added or removed, built anew. It is also built anew
/// once changes have degraded it.
class ObjectTree {
 public:
  /// Brings the tree up to date. `changes`: the objects added, moved or removed since the last update.
  void update(const Scene::Impl& scene, const ObjectChanges& changes);

  /// Float boxes, in world coordinates minus anchor(), that contain the objects' world boxes. A leaf's link is
  /// kLinkLeaf plus its object's id. Empty without objects. The root is first; nodes may be left over from removed
  /// objects.
  const NodeVector<gpu::ObjectNode>& nodes() const { return nodes_; }
  /// A point amid the objects when the tree was built; keeps a scene far from its origin precise.
  const Vector& anchor() const { return anchor_; }
  /// A box that contains all objects; empty if there have been none.
  const Box& worldBox() const { return world_; }
  /// The leaf of an object; kNone if floats cannot hold the tree.
  uint32_t leafOf(ObjectId object) const { return leaves_[object]; }
  /// kNone: the node is the root.
  uint32_t parentOf(uint32_t node) const { return parents_[node]; }
  /// At least the number of nodes on the longest path from the root to a leaf.
  uint32_t depth() const { return depth_; }
  /// Whether floats can hold the tree (kMostCoordinate).
  bool inRange() const { return inRange_; }
  /// Increases with every change of the tree; unique over all trees.
  uint64_t version() const { return version_; }
  /// The version() at which links, or the anchor, last changed.
  uint64_t structure() const { return structure_; }
  /// The version() at which nodes last changed.
  const ChangedPages& changedNodes() const { return changed_; }

 private:
  void updateAll(const Scene::Impl& scene);
  void build(const Scene::Impl& scene);
  struct Around {
    Box box;
    bool inRange = true;
  };
  Around fitLeaves(const Scene::Impl& scene, size_t first, size_t last, bool fits);
  void listSubtrees(const BoxTree& tree);
  void refit();
  double cost() const;

  bool isWorn() const;
  void apply(const Scene::Impl& scene, ObjectId object);
  void insert(ObjectId object, const Box& box);
  void remove(ObjectId object);
  void fit(uint32_t node, const Box& box);
  void fitUpwards(uint32_t node);
  void adopt(uint32_t node);

  void touch(uint32_t node) { changed_.mark(node, next_); }

  NodeVector<gpu::ObjectNode> nodes_;
  ChangedPages changed_;
  std::vector<uint32_t> parents_;  // by node; kNone: the root
  std::vector<uint32_t> leaves_;   // by object id; kNone: not in the tree
  struct Range {
    uint32_t first, last;
  };
  std::vector<Range> subtrees_;     // of the tree as built: large ones without their roots
  std::vector<uint32_t> topNodes_;  // of the tree as built: those above, parents before children
  size_t builtNodes_ = 0;           // nodes of the tree as built
  Vector anchor_{};
  Box world_;
  uint32_t depth_ = 0;
  bool inRange_ = true;
  double builtCost_ = 0, cost_ = 0;
  size_t edits_ = 0;  // insertions and removals since the tree was built
  uint64_t seenStructure_ = 0, seenPose_ = 0, version_ = 0, structure_ = 0;
  uint64_t next_ = 0;  // the version that an update makes
};

/// Sets the anchor as two floats per axis, as shaders take it.
template <class Push>
void setAnchor(Push& push, const ObjectTree& tree) {
  for (int k = 0; k < 3; ++k) {
    const TwoFloats anchor = twoFloats(tree.anchor()[k]);
    push.anchor[k] = anchor.high;
    push.anchorLow[k] = anchor.low;
  }
}

/// Floats hold squares and cubes of coordinates and sizes up to this, with room for the values they are compared with.
/// Larger world coordinates, and sizes below its inverse, are left to double precision.
inline constexpr double kMostCoordinate = 0x1p80;

}  // namespace radar
