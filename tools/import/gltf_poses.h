// The poses of the nodes of a glTF 2 file in double precision. Assimp calculates with floats and normalises nothing: of
// a quarter turn, its entries are 6e-8 and 0.99999994.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "radar/scene.h"

namespace radar::tools {

class GltfPoses {
 public:
  /// A node, or nothing. It must not outlive the GltfPoses.
  class Node {
   public:
    Node() = default;
    Node(const nlohmann::json* document, const nlohmann::json* node, const nlohmann::json* children)
        : document_(document), node_(node), children_(children) {}
    /// parentFromNode, its quaternion normalised. `rounded`: what assimp makes of it, which is returned for nothing, or
    /// if the two are not of one node.
    Transform pose(const Transform& rounded) const;
    /// The child of this number; nothing if there are not so many children.
    Node child(size_t number, size_t children) const;

   private:
    const nlohmann::json *document_ = nullptr, *node_ = nullptr, *children_ = nullptr;
  };

  /// Of a .gltf or .glb file; of any other, nothing.
  explicit GltfPoses(const std::filesystem::path& file);
  /// The node that assimp makes the root: the scene's own if it has one, else one with all of them as children.
  Node root() const;

 private:
  nlohmann::json document_;
};

}  // namespace radar::tools
