// Scenes in which a host moves objects and deforms meshes without bounds: as the engine knows them, and as they are.
#pragma once

#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "embed/on_device.h"
#include "radar/recorder.h"
#include "scene/scene.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::test {

/// How large and how far away objects are: powers of two.
struct Scales {
  double size = 1;     ///< of objects
  double spread = 16;  ///< of their places
  double away = 0;     ///< of all of them, from the origin
  double anchor = 0;   ///< the same, where the scene has them
};

/// An object's transform in floats: turned, sheared, mirrored.
inline Transform floatPose(tools::Random& random, double size, const tools::Vec3& at) {
  Transform pose = random.affine(at);
  for (size_t i = 0; i < 12; ++i) {
    pose.m[i] = static_cast<float>(i % 4 == 3 ? pose.m[i] : size * pose.m[i]);
  }
  return pose;
}

/// Meshes of a box, a pyramid and a soup, each near its origin, far from it, and flat.
inline std::vector<MeshId> addSmallMeshes(Scene& scene, uint64_t seed) {
  tools::Random random(seed);
  std::vector<MeshId> ids;
  for (uint32_t i = 0; i < 9; ++i) {
    tools::MeshData mesh = i % 3 == 0   ? tools::makeBox({1, 0.7, 1.3})
                           : i % 3 == 1 ? tools::makeRod(0.5, 1.5, 5)
                                        : tools::makeSoup(tools::Soup::plain, 12, random);
    for (size_t k = 0; k < mesh.positions.size(); ++k) {
      if (i / 3 == 1) mesh.positions[k] += 300;
      if (i / 3 == 2 && k % 3 == 1) mesh.positions[k] = 0.25f;
    }
    ids.push_back(scene.addMesh(mesh.positions, mesh.indices));
  }
  return ids;
}

class MovedWorld {
 public:
  /// `movedOf`: whether a host moves an object; of those, `boundedOf` says which have bounds.
  template <class IsMoved, class IsBounded>
  MovedWorld(uint32_t objects, uint64_t seed, const Scales& given, const IsMoved& isMoved, const IsBounded& isBounded,
             const Device& on = test::device())
      : scales(given), random(seed), device_(&on) {
    meshes = addSmallMeshes(scene, seed);
    addSmallMeshes(truth, seed);
    const tools::Vec3 centre = random.inCube(scales.away), rest = random.inCube(scales.anchor);
    for (ObjectId id = 0; id < objects; ++id) {
      const MeshId mesh = meshes[random.below(9)];
      const uint32_t mask = random.oneIn(8) ? 2 : 3;
      const bool moves = isMoved(id);
      const Transform there = poseNear(mesh, centre);
      scene.addObject({mesh, moves ? poseNear(mesh, rest) : there, mask});
      truth.addObject({mesh, there, mask});
      if (!moves) continue;
      moved.push_back(id);
      if (isBounded(id)) declareBounds(id);
    }
    show();
  }

  /// All moved objects go elsewhere.
  void moveAgain() {
    const tools::Vec3 centre = random.inCube(scales.away);
    for (const ObjectId id : moved) truth.setTransform(id, poseNear(truth.object(id).mesh, centre));
    show();
  }

  /// Writes the host's buffer.
  void show() {
    std::vector<std::byte> bytes(8);
    for (const ObjectId id : moved) {
      for (const double entry : truth.object(id).worldFromMesh.m) append<float>(bytes, {static_cast<float>(entry)});
    }
    buffers_.emplace_back(bytes, *device_);
    group_ = {.transforms = buffers_.back().get(), .first = 8, .objects = moved};
  }
  /// Some meshes get another shape in the host's buffers; the others have the scene's.
  void deformAgain() {
    deformed_.clear();
    vertices_.clear();
    for (const MeshId mesh : meshes) {
      const std::span<const float> rest = scene.mesh(mesh).positions;
      std::vector<float> positions(rest.begin(), rest.end());
      if (random.oneIn(3)) {
        const double scale = random.uniform(0.25, 2);
        for (float& x : positions) x = static_cast<float>(scale * x + random.uniform(-0.1, 0.1));
        vertices_.push_back(bufferOf(positions, *device_));
        deformed_.push_back({mesh, {.buffer = vertices_.back().get()}});
      }
      truth.setPositions(mesh, positions);
    }
  }
  /// The scene learns where the objects and their vertices are.
  void tell() {
    for (const ObjectId id : moved) scene.setTransform(id, truth.object(id).worldFromMesh);
    for (const DeformedMesh& one : deformed_) scene.setPositions(one.mesh, truth.mesh(one.mesh).positions);
  }
  HostGeometry geometry() const { return {.meshes = deformed_, .objects = {&group_, 1}}; }

  /// Sensors near objects, that move towards others, and some at random.
  std::vector<Query> queries(uint32_t count) {
    std::vector<Query> all;
    const auto objects = truth.objectLimit();
    for (uint32_t i = 0; i < count; ++i) {
      Query query;
      query.mesh = meshes[random.below(9)];
      const tools::Vec3 from = placeOf(random.below(objects)), to = placeOf(random.below(objects));
      tools::Vec3 at = from, away = random.direction();
      for (size_t k = 0; k < 3; ++k) at[k] += 2 * scales.size * away[k];
      query.worldFromMesh = poseAt(query.mesh, at);
      for (size_t k = 0; k < 3; ++k) query.direction[k] = static_cast<float>(to[k] - at[k]);
      if (query.direction == std::array<double, 3>{} || random.oneIn(4)) query.direction = random.direction();
      for (double& x : query.direction) x = static_cast<float>(x);
      if (random.oneIn(6)) query.direction = random.axis();
      query.distance = static_cast<float>(random.oneIn(4) ? 1e30 : scales.spread * random.uniform(0, 3));
      query.anyHit = random.oneIn(8);
      query.mask = random.oneIn(4) ? 1 : ~0u;
      if (random.oneIn(4)) query.exclude = {random.below(objects)};
      all.push_back(query);
    }
    return all;
  }

  Scene scene, truth;
  Scales scales;
  tools::Random random;
  std::vector<MeshId> meshes;
  std::vector<ObjectId> moved;

 private:
  /// The mesh's middle goes to `at`.
  Transform poseAt(MeshId mesh, const tools::Vec3& at) {
    const Mesh& data = truth.impl().meshes[mesh];
    Transform pose = floatPose(random, scales.size, at);
    for (size_t row = 0; row < 3; ++row) {
      double& place = pose.m[4 * row + 3];
      for (size_t k = 0; k < 3; ++k)
        place -= pose.m[4 * row + k] * (data.origin[k] + data.box.middle(static_cast<int>(k)));
      place = static_cast<float>(place);
    }
    return pose;
  }
  Transform poseNear(MeshId mesh, const tools::Vec3& centre) {
    tools::Vec3 at = random.inCube(scales.spread);
    for (size_t k = 0; k < 3; ++k) at[k] += centre[k];
    return poseAt(mesh, at);
  }
  tools::Vec3 placeOf(ObjectId id) const {
    const Box box = boxOf(truth.impl().meshes[truth.object(id).mesh], truth.object(id).worldFromMesh.m);
    return {box.middle(0), box.middle(1), box.middle(2)};
  }
  void declareBounds(ObjectId id) {
    const double reach = 4 * (scales.away + scales.spread + 1000 * scales.size);
    scene.setBounds(id, {{-reach, -reach, -reach}, {reach, reach, reach}});
  }

  const Device* device_;
  std::deque<OnDevice> buffers_, vertices_;
  MovedObjects group_;
  std::vector<DeformedMesh> deformed_;
};

}  // namespace radar::test
