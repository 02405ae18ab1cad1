// The bounding-volume tree over a scene's objects, as both searches walk it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/box.h"
#include "radar/radar.h"
#include "shaders/interop.h"

namespace radar {

/// Follows a scene: built when objects come or go, refitted when they move, rebuilt when refitting has made it bad.
class ObjectTree {
 public:
  /// Brings the tree up to date.
  void update(const Scene::Impl& scene);

  /// Boxes in floats, world coordinates less anchor(), that hold the objects' world boxes. A leaf's link is kLinkLeaf
  /// and its object's id. None where there are no objects.
  const std::vector<gpu::ObjectNode>& nodes() const { return nodes_; }
  /// Amid the objects as they were when the tree was built, so that a scene far from its origin keeps its precision.
  const Vector& anchor() const { return anchor_; }
  /// Of all objects; empty where there are none.
  const Box& worldBox() const { return world_; }
  /// Of one, world coordinates: where it is, and where a host may move it.
  const Box& boxOf(ObjectId object) const { return boxes_[object]; }
  /// Nodes on the longest way from the root to a leaf.
  uint32_t depth() const { return depth_; }
  /// Whether all boxes are within the range in which floats can hold the tree (kMostCoordinate).
  bool inRange() const { return inRange_; }
  /// Rises with every change of the tree; unlike that of any other.
  uint64_t version() const { return version_; }

 private:
  void build(const Scene::Impl& scene);
  void refit();
  double cost() const;

  std::vector<gpu::ObjectNode> nodes_;
  std::vector<Box> boxes_;  // of every object id
  Vector anchor_{};
  Box world_;
  uint32_t depth_ = 0;
  bool inRange_ = true;
  double builtCost_ = 0;
  uint64_t seenStructure_ = 0, seenPose_ = 0, version_ = 0;
};

/// Coordinates and sizes of which floats can hold squares and cubes, with room for what they are compared with: world
/// units beyond, and below its inverse, are left to double precision.
inline constexpr double kMostCoordinate = 0x1p80;

}  // namespace radar
