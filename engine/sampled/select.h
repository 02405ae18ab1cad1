// The objects in a sensor's swept prism.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace radar {

/// A box in a frame of its own: frame = axes (world from frame, orthonormal rows) about `origin`. World units.
struct Prism {
  Vector origin;
  std::array<Vector, 3> axes;  ///< axes[k] is the frame's k-th axis in world coordinates
  Box box;                     ///< in the frame
};

/// Appends the ids of all objects whose world box meets the prism's, in no order. Never leaves out one that touches the
/// prism; may name some that do not.
void selectObjects(const Scene::Impl& scene, const Prism& prism, std::vector<ObjectId>& out);

}  // namespace radar
