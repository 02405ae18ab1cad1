// Answers as an animated glTF 2.0 file, which Blender and other programs open.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "view/cut.h"

namespace radar::tools {

struct Gltf {
  std::string bytes;               ///< of a binary glTF file (.glb)
  std::vector<std::string> notes;  ///< what it leaves out, in sentences, which the file has, too
};

/// A glTF scene for each scene with queries, or for each if there are none: below one node that turns z upwards, a node
/// for each object, and a node for each sensor that moves in 3 seconds along its way and stops at its contact; objects
/// with motions move, too. Materials tell the statuses apart; a sensor's node has the answer as extras. Poses with
/// shear, which glTF does not know, are applied to the vertices. An instance without a mesh (kNone) is left out.
/// Queries and objects are cut as those of a page are (page.h).
Gltf gltfOf(const Workload& workload, std::span<const Result> answers, const LeftOut& left);

}  // namespace radar::tools
