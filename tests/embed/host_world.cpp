#include "embed/host_world.h"

#include <algorithm>
#include <cmath>

#include "scene/scene.h"
#include "support/small_scenes.h"
#include "workloads/random.h"

namespace radar::test {

namespace {

using tools::Random;
using tools::Vec3;

/// Vertices that a mesh may have had before the host deformed it: near those that it has, or anywhere among them, and,
/// if it `mayLeave` their bounds, of any size and elsewhere.
std::vector<float> restOf(const MeshView& mesh, bool mayLeave, Random& random) {
  const Bounds bounds = boundsOf(mesh.positions);
  std::vector<float> rest(mesh.positions.begin(), mesh.positions.end());
  const bool isNear = random.oneIn(2);
  const double scale = mayLeave ? std::exp2(random.uniform(-4, 4)) : 1, away = mayLeave ? random.uniform(-3, 3) : 0;
  for (size_t i = 0; i < rest.size(); ++i) {
    const double lo = bounds.lo[i % 3], hi = bounds.hi[i % 3];
    const double value = isNear ? rest[i] + 0.05 * random.uniform(lo - hi, hi - lo) : random.uniform(lo, hi);
    rest[i] = static_cast<float>(std::clamp(value, lo, hi) * scale + away * (hi - lo));
  }
  return rest;
}

/// Bounds of a placed mesh, with room for the rounding of float arithmetic on a mesh far from its origin.
Bounds roomyBounds(const Mesh& mesh, const Transform& pose, Random& random) {
  const Box box = boxOf(mesh, pose.m);
  double magnitude = 0;
  for (size_t i = 0; i < 12; ++i) {
    const size_t k = i % 4;
    const double column = k == 3 ? 1 : std::abs(mesh.origin[k]) + std::abs(mesh.box.lo[k]) + std::abs(mesh.box.hi[k]);
    magnitude = std::max(magnitude, std::abs(pose.m[i]) * column);
  }
  const double room = 1e-5 * magnitude + (random.oneIn(2) ? 0 : 0.5 * (box.hi[0] - box.lo[0]));
  Bounds bounds;
  for (size_t k = 0; k < 3; ++k) {
    bounds.lo[k] = box.lo[k] - room;
    bounds.hi[k] = box.hi[k] + room;
  }
  return bounds;
}

/// A box, a pyramid and a soup, each near its origin, far from it, and flat.
std::vector<tools::MeshData> smallMeshes(uint64_t seed) {
  Random random(seed);
  std::vector<tools::MeshData> meshes;
  for (uint32_t i = 0; i < 9; ++i) {
    meshes.push_back(i % 3 == 0   ? tools::makeBox({1, 0.7, 1.3})
                     : i % 3 == 1 ? tools::makeRod(0.5, 1.5, 5)
                                  : tools::makeSoup(tools::Soup::plain, 12, random));
    std::vector<float>& positions = meshes.back().positions;
    for (size_t k = 0; k < positions.size(); ++k) {
      if (i / 3 == 1) positions[k] += 300;
      if (i / 3 == 2 && k % 3 == 1) positions[k] = 0.25f;
    }
  }
  return meshes;
}

}  // namespace

void ask(Recorder& recorder, std::span<const Query> queries, HostWorld& world, fuzz::Outcomes& outcomes) {
  const Answers found = execute(world.device(), recorder, queries, world.geometry());
  fuzz::checkRecorded(queries, found, CpuSweeper(world.truth).run(queries), outcomes);
}

void ask(Recorder& recorder, const Written& queries, HostWorld& world, fuzz::Outcomes& outcomes) {
  const Answers found = execute(world.device(), recorder, HostQueries(queries), world.geometry());
  fuzz::checkRecorded(queries.same, found, CpuSweeper(world.truth).run(queries.same), outcomes);
}

Bounds boundsOf(std::span<const float> positions) {
  Bounds bounds{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (size_t i = 0; i < positions.size(); ++i) {
    bounds.lo[i % 3] = std::min(bounds.lo[i % 3], double{positions[i]});
    bounds.hi[i % 3] = std::max(bounds.hi[i % 3], double{positions[i]});
  }
  return bounds;
}

void hide(HostWorld& world, uint32_t seed, bool mayBound) {
  Random random(seed);
  world.moved.clear();
  world.deformed.clear();
  tools::replaceBy({.scenes = {{}}}, 0, world.scene);
  for (MeshId id = 0; world.truth.hasMesh(id); ++id) {
    const MeshView mesh = world.truth.mesh(id);
    if (random.oneIn(3)) {
      world.scene.addMesh(mesh.positions, mesh.indices);
      continue;
    }
    std::optional<Bounds> bounds;
    if (mayBound && random.oneIn(2)) bounds = boundsOf(mesh.positions);
    world.scene.addMesh(restOf(mesh, !bounds, random), mesh.indices, bounds);
    world.deformed.push_back(id);
  }
  for (ObjectId id = 0; world.truth.hasObject(id); ++id) {
    Object object = world.truth.object(id);
    if (random.oneIn(2)) {
      world.scene.addObject(object);
      continue;
    }
    for (double& entry : object.worldFromMesh.m) entry = static_cast<float>(entry);
    world.truth.setTransform(id, object.worldFromMesh);
    const Bounds bounds = roomyBounds(world.truth.impl().meshes[object.mesh], object.worldFromMesh, random);
    object.worldFromMesh.m[3] += 1;
    world.scene.addObject(object);
    if (mayBound && !random.oneIn(3)) world.scene.setBounds(id, bounds);
    world.moved.push_back(id);
  }
}

Transform floatPose(Random& random, double size, const Vec3& at) {
  Transform pose = random.affine(at);
  for (size_t i = 0; i < 12; ++i) {
    pose.m[i] = static_cast<float>(i % 4 == 3 ? pose.m[i] : size * pose.m[i]);
  }
  return pose;
}

MovedWorld::MovedWorld(uint32_t objects, uint64_t seed, const Scales& given, const OfObjects& isMoved,
                       const OfObjects& isBounded, const Device& on)
    : HostWorld(on), scales(given), random(seed) {
  for (const tools::MeshData& mesh : smallMeshes(seed)) {
    meshes.push_back(addMesh(scene, mesh));
    addMesh(truth, mesh);
  }
  const Vec3 centre = random.inCube(scales.away), rest = random.inCube(scales.anchor);
  for (ObjectId id = 0; id < objects; ++id) {
    const MeshId mesh = meshes[random.below(9)];
    const uint32_t mask = random.oneIn(8) ? 2 : 3;
    const Transform there = poseNear(mesh, centre);
    truth.addObject({mesh, there, mask});
    scene.addObject({mesh, isMoved(id) ? poseNear(mesh, rest) : there, mask});
    if (!isMoved(id)) continue;
    moved.push_back(id);
    const double room = 4 * (scales.away + scales.spread + 1000 * scales.size);
    if (isBounded(id)) scene.setBounds(id, {{-room, -room, -room}, {room, room, room}});
  }
}

void MovedWorld::moveAgain() {
  const Vec3 centre = random.inCube(scales.away);
  for (const ObjectId id : moved) truth.setTransform(id, poseNear(truth.object(id).mesh, centre));
}

void MovedWorld::deformAgain() {
  deformed.clear();
  for (const MeshId mesh : meshes) {
    std::vector<float> positions(scene.mesh(mesh).positions.begin(), scene.mesh(mesh).positions.end());
    if (random.oneIn(3)) {
      const double scale = std::exp2(random.uniform(-6, 3));
      for (float& x : positions) x = static_cast<float>(scale * x + random.uniform(-0.1, 0.1));
      deformed.push_back(mesh);
    }
    truth.setPositions(mesh, positions);
  }
}

std::vector<Query> MovedWorld::queries(uint32_t count) {
  std::vector<Query> all;
  const auto objects = truth.objectLimit();
  for (uint32_t i = 0; i < count; ++i) {
    Query query;
    query.mesh = meshes[random.below(9)];
    const Vec3 from = placeOf(random.below(objects)), to = placeOf(random.below(objects));
    Vec3 at = from, away = random.direction();
    for (size_t k = 0; k < 3; ++k) at[k] += 2 * scales.size * away[k];
    query.worldFromMesh = poseAt(query.mesh, at);
    for (size_t k = 0; k < 3; ++k) query.direction[k] = static_cast<float>(to[k] - at[k]);
    if (query.direction == Vec3{} || random.oneIn(4)) query.direction = random.direction();
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

void MovedWorld::remove(ObjectId id) {
  scene.removeObject(id);
  truth.removeObject(id);
  std::erase(moved, id);
}

ObjectId MovedWorld::add(const Object& object) {
  truth.addObject(object);
  return scene.addObject(object);
}

/// The mesh's middle goes to `at`.
Transform MovedWorld::poseAt(MeshId mesh, const Vec3& at) {
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

Transform MovedWorld::poseNear(MeshId mesh, const Vec3& centre) {
  Vec3 at = random.inCube(scales.spread);
  for (size_t k = 0; k < 3; ++k) at[k] += centre[k];
  return poseAt(mesh, at);
}

Vec3 MovedWorld::placeOf(ObjectId id) const {
  const Box box = boxOf(truth.impl().meshes[truth.object(id).mesh], truth.object(id).worldFromMesh.m);
  return {box.middle(0), box.middle(1), box.middle(2)};
}

}  // namespace radar::test
