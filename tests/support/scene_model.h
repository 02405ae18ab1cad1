// What a scene holds.
#pragma once

#include <map>
#include <optional>

#include "radar/scene.h"

namespace radar::test {

struct SceneModel {
  struct Mesh {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    std::optional<Bounds> bounds{};  ///< the default slack of queries depends on them
  };
  std::map<MeshId, Mesh> meshes;
  std::map<ObjectId, Object> objects;

  /// But for the bounds.
  bool operator==(const SceneModel& other) const;
  /// A scene with the same numbers of meshes and objects.
  Scene build() const;
  static SceneModel of(const Scene& scene);
};

}  // namespace radar::test
