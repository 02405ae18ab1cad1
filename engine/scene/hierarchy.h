// A tree over the world boxes of a scene's objects, asked for those in a sensor's swept prism.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace radar {

/// A box in a frame of its own: frame = axes (world from frame, orthonormal rows) about `origin`. World units.
struct Prism {
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;  ///< axes[k] is the frame's k-th axis in world coordinates
  Box box;                                    ///< in the frame
};

/// Follows a scene: built when objects come or go, refitted when they move, rebuilt when refitting has made it bad.
class Hierarchy {
 public:
  /// Brings the tree up to date.
  void update(const Scene::Impl& scene);

  /// Appends the ids of all objects whose world box meets the prism's, in no order. Never leaves out one that touches
  /// the prism; may name some that do not.
  void collect(const Prism& prism, std::vector<ObjectId>& out) const;

 private:
  // 64 bytes. Leaves hold objects_[first, first + count); inner nodes (count 0) children at `first` and `first` + 1.
  struct Node {
    Box box;
    uint32_t first = 0, count = 0;
  };

  void build(const Scene::Impl& scene);
  void split(uint32_t node, uint32_t first, uint32_t count);
  void refit();
  double cost() const;

  std::vector<Node> nodes_;
  std::vector<ObjectId> objects_;
  std::vector<Box> boxes_;  // of every object id
  double builtCost_ = 0;
  uint64_t seenScene_ = 0, seenStructure_ = 0, seenPose_ = 0;
};

}  // namespace radar
