// A scene whose meshes may be about a base.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "radar/scene.h"

namespace radar::python {

/// Poses are given, and given back, for base + vertex; the scene has those of the vertices alone.
class BasedScene {
 public:
  using Base = std::array<double, 3>;

  const Scene& scene() const { return scene_; }
  const Base& base(MeshId mesh) const { return bases_.at(mesh); }
  /// Of a round sensor (radar/shapes.h), else 0; also of a mesh that does not exist.
  double radius(MeshId mesh) const { return mesh < radii_.size() ? radii_[mesh] : 0; }
  /// What a mesh only shows; without parts if it shows none, or does not exist.
  Cutter cutter(MeshId mesh) const { return mesh < cutters_.size() ? cutters_[mesh] : Cutter{}; }
  /// The scene's pose for one that is given.
  Transform placed(MeshId mesh, const Transform& given) const;
  const Transform& given(ObjectId object) const;

  // As those of Scene.
  MeshId addMesh(std::span<const float> positions, std::span<const uint32_t> indices, const Base& base, double radius);
  MeshId addCutter(const Cutter& cutter) { return entered(scene_.addCutter(cutter), {}, 0, cutter); }
  void setPositions(MeshId mesh, std::span<const float> positions, const Base& base);
  void removeMesh(MeshId mesh) { scene_.removeMesh(mesh); }
  ObjectId addObject(const Object& object);
  void setTransforms(std::span<const ObjectId> objects, std::span<const Transform> given);
  void setMotion(ObjectId object, const std::array<double, 3>& motion) { scene_.setMotion(object, motion); }
  void removeObject(ObjectId object);

 private:
  MeshId entered(MeshId mesh, const Base& base, double radius, const Cutter& cutter = {});

  Scene scene_;
  std::vector<Base> bases_;              // by mesh
  std::vector<double> radii_;            // likewise
  std::vector<Cutter> cutters_;          // likewise
  std::map<ObjectId, Transform> given_;  // where the scene's is another
};

}  // namespace radar::python
