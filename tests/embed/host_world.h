// Scenes in which a host moves objects and deforms meshes: as the engine knows them, and as they are.
#pragma once

#include <functional>

#include "embed/host_frame.h"
#include "embed/written_queries.h"
#include "fuzz/check_recorded.h"
#include "workloads/random.h"

namespace radar::test {

/// A scene of which the engine does not know where a host has moved objects and how it has deformed meshes.
class HostWorld {
 public:
  explicit HostWorld(const Device& on = test::device()) : device_(&on), frame_(on) {}

  /// What the host's buffers hold: the truth, rounded to floats. Until the next call.
  HostGeometry geometry() {
    frame_ = HostFrame(*device_);
    for (const MeshId mesh : deformed) frame_.deform(mesh, truth.mesh(mesh).positions);
    for (const ObjectId id : moved) frame_.move(id, truth.object(id).worldFromMesh);
    return frame_.geometry();
  }
  /// The engine learns where the objects and their vertices are.
  void tell() {
    for (const ObjectId id : moved) scene.setTransform(id, truth.object(id).worldFromMesh);
    for (const MeshId mesh : deformed) scene.setPositions(mesh, truth.mesh(mesh).positions);
  }

  const Device& device() const { return *device_; }

  Scene scene, truth;
  std::vector<ObjectId> moved;   ///< by the host
  std::vector<MeshId> deformed;  ///< likewise

 private:
  const Device* device_;
  HostFrame frame_;
};

/// Records queries over the world's geometry, and holds the answers against the CPU's about the truth.
void ask(Recorder& recorder, std::span<const Query> queries, HostWorld& world, fuzz::Outcomes& outcomes);
void ask(Recorder& recorder, const Written& queries, HostWorld& world, fuzz::Outcomes& outcomes);

/// The smallest bounds of the vertices.
Bounds boundsOf(std::span<const float> positions);

/// Makes the scene of the truth, but for what a host keeps to itself: how about two thirds of the meshes are deformed
/// and where half of the objects are, whose poses in the truth are rounded to floats. If `mayBound`, some have bounds.
void hide(HostWorld& world, uint32_t seed, bool mayBound);

/// How large and how far away objects are: powers of two.
struct Scales {
  double size = 1;     ///< of objects
  double spread = 16;  ///< of their places
  double away = 0;     ///< of all of them, from the origin
  double anchor = 0;   ///< the same, where the scene has them
};

/// An object's transform in floats: turned, sheared, mirrored.
Transform floatPose(tools::Random& random, double size, const tools::Vec3& at);

/// Which objects are moved, or have bounds.
using OfObjects = std::function<bool(ObjectId)>;
inline bool always(ObjectId) {
  return true;
}
inline bool never(ObjectId) {
  return false;
}

/// Objects of small meshes at random places.
class MovedWorld : public HostWorld {
 public:
  MovedWorld(uint32_t objects, uint64_t seed, const Scales& given, const OfObjects& isMoved = always,
             const OfObjects& isBounded = never, const Device& on = test::device());

  /// All moved objects go elsewhere.
  void moveAgain();
  /// Some meshes get another shape; the others have the scene's.
  void deformAgain();
  /// Sensors near objects, that move towards others, and some at random. Each excludes at most one.
  std::vector<Query> queries(uint32_t count);
  /// Removed from the scene, and from what is moved.
  void remove(ObjectId id);
  /// To the scene.
  ObjectId add(const Object& object);

  Scales scales;
  tools::Random random;
  std::vector<MeshId> meshes;

 private:
  Transform poseAt(MeshId mesh, const tools::Vec3& at);
  Transform poseNear(MeshId mesh, const tools::Vec3& centre);
  tools::Vec3 placeOf(ObjectId id) const;
};

}  // namespace radar::test
