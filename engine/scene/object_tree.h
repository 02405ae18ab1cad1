// The bounding-volume tree over a scene's objects, for the searches on the device and on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/box.h"
#include "radar/radar.h"
#include "shaders/shared/interop.h"

namespace radar {

/// Follows a scene: rebuilt if objects are added or removed, refitted if they move, rebuilt if refitting has degraded
/// it.
class ObjectTree {
 public:
  /// Brings the tree up to date.
  void update(const Scene::Impl& scene);

  /// Float boxes, in world coordinates minus anchor(), that contain the objects' world boxes. A leaf's link is
  /// kLinkLeaf plus its object's id. Empty without objects.
  const std::vector<gpu::ObjectNode>& nodes() const { return nodes_; }
  /// A point amid the objects when the tree was built; keeps a scene far from its origin precise.
  const Vector& anchor() const { return anchor_; }
  /// The box of all objects; empty without objects.
  const Box& worldBox() const { return world_; }
  /// An object's world box, its motion and its bounds from setBounds included.
  const Box& boxOf(ObjectId object) const { return boxes_[object]; }
  /// Nodes on the longest path from the root to a leaf.
  uint32_t depth() const { return depth_; }
  /// Whether floats can hold the tree (kMostCoordinate).
  bool inRange() const { return inRange_; }
  /// Increases with every change of the tree; unique over all trees.
  uint64_t version() const { return version_; }

 private:
  void build(const Scene::Impl& scene);
  void refit();
  double cost() const;

  std::vector<gpu::ObjectNode> nodes_;
  std::vector<Box> boxes_;  // by object id
  Vector anchor_{};
  Box world_;
  uint32_t depth_ = 0;
  bool inRange_ = true;
  double builtCost_ = 0;
  uint64_t seenStructure_ = 0, seenPose_ = 0, version_ = 0;
};

/// Floats hold squares and cubes of coordinates and sizes up to this, with room for the values they are compared with.
/// Larger world coordinates, and sizes below its inverse, are left to double precision.
inline constexpr double kMostCoordinate = 0x1p80;

}  // namespace radar
