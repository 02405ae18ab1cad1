// A scene: meshes, and objects that place them. Lengths may be in any one unit; angles never appear. Coordinates may be
// left- or right-handed. Meshes are two-sided triangle soups: winding is ignored, and they need not be closed or
// connected.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radar/cutters.h"
#include "radar/error.h"

namespace radar {

/// No object, no triangle.
inline constexpr uint32_t kNone = 0xffffffffu;

class Device;
struct HostMesh;

/// A placement: world = M p + t, with row-major rows (m0 m1 m2 t). M is any invertible matrix, mirrors included; no
/// number is above 2^800, so that no placed vertex overflows.
/// Vertices are placed as ((m0*x + m1*y) + m2*z) + t in double precision, without fused multiply-add; this result *is*
/// the geometry.
struct Transform {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  friend bool operator==(const Transform&, const Transform&) = default;
};

/// Places the mesh vertex `p` by the formula above.
RADAR_API std::array<double, 3> transformPoint(const Transform& pose, const float* p);

/// Ids are small integers. An id names one mesh or object until that is removed, whatever else is added or removed. New
/// items get the least free id, so objects added to a fresh scene are 0, 1, 2, ..., and arrays by id stay small. A
/// stale id is not recognised: once its item is removed, calls refuse it only until an item is added, which may get it.
/// So forget an item's id wherever it is kept (such as in Query::exclude) when the item is removed.
using MeshId = uint32_t;
using ObjectId = uint32_t;

/// An axis-aligned box, ends included.
struct Bounds {
  std::array<double, 3> lo{}, hi{};
};

/// A triangle mesh, as passed to addMesh.
struct MeshView {
  std::span<const float> positions{};   ///< 3 floats per vertex
  std::span<const uint32_t> indices{};  ///< 3 vertex numbers per triangle; triangle ids count in this order
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// An object of the scene: a placed mesh.
struct Object {
  MeshId mesh = kNone;
  Transform worldFromMesh{};
  uint32_t mask = ~0u;  ///< takes part in a query if it shares a bit with the query's mask
  /// How far it moves during the step that queries ask about, at constant velocity, world units: see Query::motion.
  std::array<double, 3> motion{};
};

/// Meshes, and objects that place them. Plain data on the CPU, independent of any device; any number of sweepers may
/// read it. Input is copied.
class RADAR_API Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Adds a mesh of positions.size()/3 vertices, at most 2^30, and indices.size()/3 triangles, at most 2^29. Throws if
  /// it has more, or no triangle, a size is not a multiple of 3, a number is not finite, or an index is out of range;
  /// with `bounds`, also if a lower bound exceeds its upper bound, or a bound or position exceeds 2^120.
  ///
  /// `bounds`, mesh units: declares that a host that deforms the mesh on its device keeps it within them
  /// (radar/host.h): see setBounds. `positions` are the rest pose: the closer they are to the deformed mesh,
  /// the faster the search. All other calls use these positions.
  MeshId addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                 const std::optional<Bounds>& bounds = std::nullopt);
  /// Adds a cutter, as a mesh that shows it: queries that move this mesh are about the solid itself (radar/query.h).
  /// Their poses are rigid to 1e-6; no object of a scene, and no link of a chain, is a cutter. Throws unless it has a
  /// part, each part's rings span a solid, heights are at most 2^100 and radii from 0 to that.
  MeshId addCutter(const Cutter& cutter);
  /// Moves the vertices of a mesh: 3 floats for each, as many as it has. Its tree is fitted to them, and built anew
  /// only if that would make it much worse. Throws if the mesh does not exist, is a cutter or has another number of
  /// vertices, a number is not finite, or a triangle's vertex is outside the mesh's `bounds`.
  void setPositions(MeshId mesh, std::span<const float> positions);
  /// Throws if an object uses the mesh.
  void removeMesh(MeshId mesh);

  /// Throws if the mesh does not exist or is a cutter, the pose is singular or has a number that is not finite or above
  /// 2^800, a component of the motion is above 2^1000, or the scene has 2^29 objects.
  ObjectId addObject(const Object& object);
  void setTransform(ObjectId object, const Transform& worldFromMesh);
  /// The same for many objects, one transform each, on all cores; the last one counts if an object is given twice.
  /// Throws, naming the object, before anything is set.
  void setTransforms(std::span<const ObjectId> objects, std::span<const Transform> worldFromMesh);
  /// Sets Object::motion. The pose stays that at the start of the step.
  void setMotion(ObjectId object, const std::array<double, 3>& motion);
  /// Declares that a host that moves the object on its device keeps it within `world` (radar/host.h). Larger
  /// bounds cost more time. All other calls use the object's pose. Replaces earlier bounds, which end with the object.
  /// Throws if the object does not exist, a lower bound exceeds its upper bound, or a bound exceeds 2^120.
  void setBounds(ObjectId object, const Bounds& world);
  void removeObject(ObjectId object);

  bool hasMesh(MeshId mesh) const;
  bool hasObject(ObjectId object) const;
  /// Valid until the mesh is removed; shows what setPositions() sets.
  MeshView mesh(MeshId mesh) const;
  /// Valid until the scene changes.
  const Object& object(ObjectId object) const;
  /// Every id in use is below this.
  MeshId meshLimit() const;
  ObjectId objectLimit() const;

  /// Increases with every change of a mesh or object.
  uint64_t version() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  friend RADAR_API MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh);  // radar/host.h
  std::unique_ptr<Impl> impl_;
};

/// Checks the contract of a pose. Returns an empty string, or what is wrong and what was expected.
RADAR_API std::string validate(const Transform& worldFromMesh);

}  // namespace radar
