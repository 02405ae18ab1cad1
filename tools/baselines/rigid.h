// Parts that the libraries share.
#pragma once

#include <functional>
#include <map>

#include "baselines/baseline.h"
#include "workloads/vectors.h"

namespace radar::tools {

/// The rows of each library.
std::vector<BaselineRow> embreeRows();
std::vector<BaselineRow> fclRows();
std::vector<BaselineRow> bulletRows();
std::vector<BaselineRow> odeRows();

template <class Library>
std::unique_ptr<Baseline> make(const Workload& workload, uint32_t size) {
  return std::make_unique<Library>(workload, size);
}

/// A library that places only what differs from the scene shown before.
class SceneBaseline : public Baseline {
 public:
  void show(std::span<const Instance> objects) final {
    const bool anew = !shownBefore_ || objects.size() != shown_.size();
    if (anew) begin(objects.size());
    for (size_t i = 0; i < objects.size(); ++i) {
      if (anew || !(objects[i] == shown_[i])) place(i, objects[i], anew);
    }
    end(anew);
    shown_.assign(objects.begin(), objects.end());
    shownBefore_ = true;
  }

 protected:
  /// Forgets all objects; place() comes for each of the new ones.
  virtual void begin(size_t count) = 0;
  /// `anew`: since begin(); otherwise the object is there and changes.
  virtual void place(size_t number, const Instance& instance, bool anew) = 0;
  virtual void end(bool /*anew*/) {}

  std::vector<Instance> shown_;

 private:
  bool shownBefore_ = false;
};

/// A pose as a linear map `bake` of the mesh and then a rigid pose, rotation * p + at. Libraries place meshes by rigid
/// poses only. `bake` holds the scale along the mesh's axes, rounded to 40 bits so that a turning shape keeps one map,
/// or the whole linear part if the pose shears or mirrors.
struct RigidPose {
  Rotation rotation{};
  Vec3 at{};
  Rotation bake{};  ///< row-major
};
RigidPose rigidPose(const Transform& pose);

/// The vertices of a mesh under a linear map, 3 numbers each.
std::vector<double> baked(const MeshData& mesh, const Rotation& linear);

bool meet(const Bounds& a, const Bounds& b);
/// Also holds all places along the motion.
Bounds swept(Bounds bounds, const Vec3& displacement);

Vec3 unitDirection(const Query& query);
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

  Shape& of(uint32_t mesh, const RigidPose& pose) {
    const auto key = std::pair(mesh, pose.bake);
    const auto found = shapes_.find(key);
    if (found != shapes_.end()) return found->second;
    const MeshData& data = workload_.meshes[mesh];
    return shapes_.emplace(key, make_(baked(data, pose.bake), data)).first->second;
  }

 private:
  const Workload& workload_;
  Make make_;
  std::map<std::pair<uint32_t, Rotation>, Shape> shapes_;
};

}  // namespace radar::tools
