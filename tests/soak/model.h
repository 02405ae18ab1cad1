// What a scene must hold.
#pragma once

#include <map>
#include <optional>

#include "radar/scene.h"

namespace radar::soak {

struct Model {
  struct Mesh {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    std::optional<Bounds> bounds{};  ///< the default slack of queries depends on them
  };
  std::map<MeshId, Mesh> meshes;
  std::map<ObjectId, Object> objects;

  /// A scene with the same numbers of meshes and objects.
  Scene build() const;
  static Model of(const Scene& scene);
};

}  // namespace radar::soak
