// The objects in a sensor's swept prism.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace radar {

/// A box in its own frame, with orthonormal `axes` about `origin`. World units.
struct Prism {
  Vector origin;
  std::array<Vector, 3> axes;  ///< axes[k]: the frame's k-th axis in world coordinates
  Box box;                     ///< in the frame
};

/// Appends the ids of objects whose world box meets the prism's, unordered. Includes all that touch the prism, and
/// possibly others.
void selectObjects(const Scene::Impl& scene, const Prism& prism, std::vector<ObjectId>& out);

}  // namespace radar
