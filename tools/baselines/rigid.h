// For libraries that place meshes by rotation and translation only: what else a pose does is baked into vertices.
#pragma once

#include <functional>
#include <map>

#include "workloads/workload.h"

namespace radar::tools {

/// World = rotation (row-major) * p + at.
struct RigidPose {
  std::array<double, 9> rotation{};
  std::array<double, 3> at{};
};

/// A pose as a rigid one after a linear map of the mesh.
struct SplitPose {
  std::array<double, 9> bake{};  ///< row-major
  RigidPose rigid;
};
/// Scaling along the mesh's axes is baked, by factors of 40 bits, so that a shape that turns stays one shape; shears
/// and mirrors are baked whole.
SplitPose split(const Transform& pose);

/// The vertices of a mesh under a linear map, 3 numbers each.
std::vector<double> baked(const MeshData& mesh, const std::array<double, 9>& linear);

struct WorldBox {
  std::array<double, 3> low{}, high{};
  bool meets(const WorldBox& other) const;
  /// Grown by where it gets along the motion.
  WorldBox swept(const std::array<double, 3>& displacement) const;
};
WorldBox boxOf(const MeshData& mesh, const Transform& pose);

std::array<double, 3> unitDirection(const Query& query);
bool isExcluded(const Query& query, uint32_t object);

/// First contact by discrete checks: the distance is walked in `steps` steps, then bisected to a millionth of a step.
/// `meets(t)`: whether sensor and scene meet there.
std::optional<double> steppedContact(double distance, uint32_t steps, const std::function<bool(double)>& meets);

/// Shapes of a library, one for each mesh and baked map, made when first asked for.
template <class Shape>
class ShapeCache {
 public:
  /// `make` gets baked vertices and the mesh they are of.
  using Make = std::function<Shape(const std::vector<double>& positions, const MeshData& mesh)>;
  ShapeCache(const Workload& workload, Make make) : workload_(workload), make_(std::move(make)) {}

  Shape& of(const Instance& instance, RigidPose& rigid) {
    const SplitPose pose = split(instance.worldFromMesh);
    rigid = pose.rigid;
    const auto key = std::pair(instance.mesh, pose.bake);
    const auto found = shapes_.find(key);
    if (found != shapes_.end()) return found->second;
    const MeshData& mesh = workload_.meshes[instance.mesh];
    return shapes_.emplace(key, make_(baked(mesh, pose.bake), mesh)).first->second;
  }

 private:
  const Workload& workload_;
  Make make_;
  std::map<std::pair<uint32_t, std::array<double, 9>>, Shape> shapes_;
};

}  // namespace radar::tools
