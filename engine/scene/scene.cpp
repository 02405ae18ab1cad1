#include "scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <new>

#include "math/float_environment.h"
#include "math/number_text.h"
#include "math/rounding.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Bounds are widened by this part of their largest coordinate, so that float arithmetic does not leave them.
constexpr double kBoundsRoom = 0x1p-18;
constexpr double kMostBound = 0x1p120;
// Least exponent of a mesh's unit: a float must hold its inverse.
constexpr int kLeastUnit = -126;

// Trees hold at most twice as many nodes as items, half as many again after edits, and a link has 30 bits for an item
// and 31 for a node (gpu::kLinkItem).
constexpr size_t kMostVertices = size_t{1} << 30, kMostTriangles = size_t{1} << 29, kMostObjects = size_t{1} << 29;

// If more objects change than this and a sixteenth of all, looking at every object is cheaper than at each change.
constexpr size_t kFewChanges = 16;
// Transforms that a thread sets at a time.
constexpr size_t kChunk = 8192;

std::string idText(const char* kind, uint32_t id) {
  return std::string(kind) + " " + std::to_string(id);
}

uint64_t nextVersion() {
  static std::atomic<uint64_t> version{0};
  return ++version;
}

double edgeLength(const Mesh& mesh, uint32_t a, uint32_t b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double difference = double(mesh.positions[3 * size_t{a} + k]) - mesh.positions[3 * size_t{b} + k];
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

// Throws if the bounds are invalid.
Box boxOf(const char* call, const Bounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    if (!(bounds.lo[k] <= bounds.hi[k] && bounds.lo[k] >= -kMostBound && bounds.hi[k] <= kMostBound)) {
      throw Error(std::string(call) + ": bounds: expected lo <= hi and magnitudes of at most 2^120, got " +
                  textOf(bounds.lo[k]) + " and " + textOf(bounds.hi[k]));
    }
  }
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = bounds.lo[k];
    box.hi[k] = bounds.hi[k];
  }
  return box;
}

// A float that makes position - origin exact for every position in [lo, hi]: 0, or exact by Sterbenz's lemma.
double originOf(double lo, double hi) {
  const double middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  return std::abs(middle) >= 2.5 * half ? static_cast<float>(middle) : 0;
}

// Computes the derived members but the tree. `box`: the bounds within which a host may deform the mesh, or empty.
void derive(Mesh& mesh, Box box) {
  // Vertices that no triangle uses must not widen the window.
  for (uint32_t vertex : mesh.indices) {
    const float* p = &mesh.positions[3 * size_t{vertex}];
    box.add({p[0], p[1], p[2]});
  }
  setBox(mesh, box);
  for (int k = 0; k < 3; ++k) {
    const double used = mesh.positions[3 * size_t{mesh.indices[0]} + k];
    mesh.local[k].assign(mesh.vertexCount(), static_cast<float>(used - mesh.origin[k]));
  }
  for (uint32_t vertex : mesh.indices) {
    for (int k = 0; k < 3; ++k) {
      mesh.local[k][vertex] = static_cast<float>(mesh.positions[3 * size_t{vertex} + k] - mesh.origin[k]);
    }
  }
  double sum = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    sum += edgeLength(mesh, a, b) + edgeLength(mesh, b, c) + edgeLength(mesh, c, a);
  }
  mesh.meanEdge = sum / static_cast<double>(mesh.indices.size());
}

void requireAtMost(const char* where, const char* what, size_t count, size_t most) {
  if (count <= most) return;
  throw Error(std::string(where) + ": expected at most " + std::to_string(most) + " " + what + ", got " +
              std::to_string(count));
}

void requireFinite(const std::string& where, std::span<const float> positions) {
  for (size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(positions[i])) throw Error(where + ": vertex " + std::to_string(i / 3) + " is not finite");
  }
}

// The bounds within which a host may deform the mesh, and its rest pose.
Box boundsOf(const Mesh& mesh) {
  Box box = mesh.box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] += mesh.origin[k];
    box.hi[k] += mesh.origin[k];
  }
  return box;
}

// Vertices that no triangle uses may be anywhere.
void requireInside(const Mesh& mesh, std::span<const float> positions) {
  const Box box = boundsOf(mesh);
  for (const uint32_t vertex : mesh.indices) {
    for (int k = 0; k < 3; ++k) {
      const float x = positions[3 * size_t{vertex} + k];
      if (x >= box.lo[k] && x <= box.hi[k]) continue;
      throw Error("setPositions: vertex " + std::to_string(vertex) + " is outside the mesh's bounds");
    }
  }
}

size_t isMoving(const Object& object) {
  return object.motion == Vector{} ? 0 : 1;
}

}  // namespace

void setBox(Mesh& mesh, const Box& box) {
  float largest = 0;
  for (int k = 0; k < 3; ++k) {
    mesh.farthest[k] = std::max(std::abs(box.lo[k]), std::abs(box.hi[k]));
    mesh.origin[k] = originOf(box.lo[k], box.hi[k]);
    mesh.box.lo[k] = box.lo[k] - mesh.origin[k];
    mesh.box.hi[k] = box.hi[k] - mesh.origin[k];
    mesh.reach[k] = roundUp(std::max(std::abs(mesh.box.lo[k]), std::abs(mesh.box.hi[k])));
    largest = std::max(largest, mesh.reach[k]);
  }
  mesh.unit = largest > 0 ? std::ldexp(1.0, std::max(std::ilogb(largest), kLeastUnit)) : 1;
}

Scene::Impl::Impl() : identity(nextVersion()) {}

const ObjectTree& Scene::Impl::objectTree() const {
  const std::scoped_lock lock(treeMutex_);
  try {
    tree_.update(*this, treeChanges_);
  } catch (...) {
    tree_ = {};  // half of it may be up to date
    throw;
  }
  treeChanges_.objects.clear();
  treeChanges_.areMany = false;
  return tree_;
}

void Scene::Impl::change(std::span<const ObjectId> changed) {
  poseVersion = nextVersion();
  for (const ObjectId object : changed) {
    changedAt[object] = poseVersion;
    changedObjects.mark(object, poseVersion);
  }
  treeChanges_.areMany =
      treeChanges_.areMany || treeChanges_.objects.size() + changed.size() > kFewChanges + objects.size() / 16;
  if (treeChanges_.areMany) return;
  try {
    treeChanges_.objects.insert(treeChanges_.objects.end(), changed.begin(), changed.end());
  } catch (const std::bad_alloc&) {
    treeChanges_.areMany = true;
  }
}

void Scene::Impl::makeRoom() {
  if (!freeObjects.empty()) return;
  const auto free = static_cast<ObjectId>(objects.size());
  objects.emplace_back();
  try {
    changedAt.resize(objects.size());
    changedObjects.resize(objects.size());
    freeObjects.push(free);
  } catch (...) {
    objects.pop_back();
    changedAt.resize(objects.size());
    changedObjects.resize(objects.size());
    throw;
  }
}

Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

MeshId Scene::addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                      const std::optional<Bounds>& bounds) {
  const FloatEnvironment floats;
  if (positions.size() % 3 != 0)
    throw Error("addMesh: positions: expected 3 floats per vertex, got " + std::to_string(positions.size()));
  if (indices.size() % 3 != 0)
    throw Error("addMesh: indices: expected 3 per triangle, got " + std::to_string(indices.size()));
  if (indices.empty()) throw Error("addMesh: expected at least one triangle, got none");
  requireAtMost("addMesh", "vertices", positions.size() / 3, kMostVertices);
  requireAtMost("addMesh", "triangles", indices.size() / 3, kMostTriangles);
  requireFinite("addMesh: positions", positions);
  for (size_t i = 0; i < positions.size(); ++i) {
    if (bounds && std::abs(positions[i]) > kMostBound) {
      throw Error("addMesh: positions: vertex " + std::to_string(i / 3) +
                  " of a mesh with bounds: expected coordinates of at most 2^120");
    }
  }
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= positions.size() / 3) {
      throw Error("addMesh: indices: triangle " + std::to_string(i / 3) + " refers to vertex " +
                  std::to_string(indices[i]) + " of " + std::to_string(positions.size() / 3));
    }
  }
  Mesh mesh;
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.indices.assign(indices.begin(), indices.end());
  mesh.used = true;
  mesh.hasBounds = bounds.has_value();
  mesh.version = nextVersion();
  Box box;
  if (bounds) box = boxOf("addMesh", *bounds);
  // The host writes floats, so the bounds are rounded outwards to floats.
  for (int k = 0; k < 3 && bounds; ++k) {
    box.lo[k] = roundDown(box.lo[k]);
    box.hi[k] = roundUp(box.hi[k]);
  }
  derive(mesh, box);
  mesh.tree = buildMeshTree(mesh);
  auto id = static_cast<MeshId>(impl_->meshes.size());
  if (impl_->freeMeshes.empty()) {
    impl_->meshes.push_back(std::move(mesh));
  } else {
    id = impl_->freeMeshes.top();
    impl_->freeMeshes.pop();
    impl_->meshes[id] = std::move(mesh);
  }
  impl_->meshVersion = nextVersion();
  return id;
}

void Scene::setPositions(MeshId id, std::span<const float> positions) {
  const FloatEnvironment floats;
  if (!hasMesh(id)) throw Error("setPositions: " + idText("mesh", id) + " does not exist");
  Mesh& mesh = impl_->meshes[id];
  if (positions.size() != mesh.positions.size()) {
    throw Error("setPositions: expected " + std::to_string(mesh.positions.size()) + " floats, 3 for each vertex, got " +
                std::to_string(positions.size()));
  }
  requireFinite("setPositions", positions);
  if (mesh.hasBounds) requireInside(mesh, positions);
  const Box bounds = mesh.hasBounds ? boundsOf(mesh) : Box{};
  const std::vector<float> before = mesh.positions;
  const auto move = [&](std::span<const float> to) {  // in place: a MeshView shows them
    std::copy(to.begin(), to.end(), mesh.positions.begin());
    derive(mesh, bounds);
  };
  move(positions);
  try {
    refitMeshTree(mesh, mesh.tree);
  } catch (...) {
    move(before);
    throw;
  }
  mesh.version = impl_->meshVersion = nextVersion();
  if (mesh.objects == 0) return;
  for (ObjectId i = 0; i < impl_->objects.size(); ++i) {
    if (impl_->objects[i].used && impl_->objects[i].object.mesh == id) impl_->change(i);
  }
}

void Scene::removeMesh(MeshId mesh) {
  if (!hasMesh(mesh)) throw Error("removeMesh: " + idText("mesh", mesh) + " does not exist");
  if (impl_->meshes[mesh].objects != 0) {
    throw Error("removeMesh: " + idText("mesh", mesh) + " is used by " + std::to_string(impl_->meshes[mesh].objects) +
                " objects");
  }
  impl_->freeMeshes.push(mesh);
  impl_->meshes[mesh] = Mesh{};
  impl_->meshVersion = nextVersion();
}

ObjectId Scene::addObject(const Object& object) {
  const FloatEnvironment floats;
  if (!hasMesh(object.mesh)) throw Error("addObject: " + idText("mesh", object.mesh) + " does not exist");
  if (std::string wrong = validate(object.worldFromMesh); !wrong.empty()) throw Error("addObject: pose: " + wrong);
  if (std::string wrong = validateMotion(object.motion); !wrong.empty()) throw Error("addObject: motion: " + wrong);
  if (impl_->freeObjects.empty()) requireAtMost("addObject", "objects", impl_->objects.size() + 1, kMostObjects);
  impl_->makeRoom();
  const ObjectId id = impl_->freeObjects.top();
  impl_->freeObjects.pop();
  impl_->objects[id] = {object, true};
  ++impl_->meshes[object.mesh].objects;
  impl_->moving += isMoving(object);
  impl_->change(id);
  impl_->structureVersion = impl_->poseVersion;
  return id;
}

void Scene::setTransform(ObjectId object, const Transform& worldFromMesh) {
  const FloatEnvironment floats;
  if (!hasObject(object)) throw Error("setTransform: " + idText("object", object) + " does not exist");
  if (std::string wrong = validate(worldFromMesh); !wrong.empty()) throw Error("setTransform: " + wrong);
  impl_->objects[object].object.worldFromMesh = worldFromMesh;
  impl_->change(object);
}

void Scene::setTransforms(std::span<const ObjectId> objects, std::span<const Transform> worldFromMesh) {
  const FloatEnvironment floats;
  if (objects.size() != worldFromMesh.size()) {
    throw Error("setTransforms: expected one transform per object, got " + std::to_string(worldFromMesh.size()) +
                " for " + std::to_string(objects.size()) + " objects");
  }
  std::atomic<size_t> wrong{objects.size()};
  parallelFor(objects.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (hasObject(objects[i]) && validate(worldFromMesh[i]).empty()) continue;
      size_t least = wrong;
      while (i < least && !wrong.compare_exchange_weak(least, i)) {
      }
      return;
    }
  });
  if (wrong < objects.size()) {
    const std::string object = "setTransforms: " + idText("object", objects[wrong]);
    if (!hasObject(objects[wrong])) throw Error(object + " does not exist");
    throw Error(object + ": " + validate(worldFromMesh[wrong]));
  }
  if (objects.empty()) return;
  const bool mayRepeat = std::ranges::adjacent_find(objects, std::ranges::greater_equal()) != objects.end();
  impl_->change(objects);  // now, in case what follows fails
  parallelFor(objects.size(), kChunk, mayRepeat ? 1 : 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) impl_->objects[objects[i]].object.worldFromMesh = worldFromMesh[i];
  });
}

void Scene::setMotion(ObjectId object, const std::array<double, 3>& motion) {
  const FloatEnvironment floats;
  if (!hasObject(object)) throw Error("setMotion: " + idText("object", object) + " does not exist");
  if (std::string wrong = validateMotion(motion); !wrong.empty()) throw Error("setMotion: " + wrong);
  Object& moved = impl_->objects[object].object;
  if (moved.motion == motion) return;
  impl_->moving -= isMoving(moved);
  moved.motion = motion;
  impl_->moving += isMoving(moved);
  impl_->change(object);
}

void Scene::setBounds(ObjectId object, const Bounds& world) {
  const FloatEnvironment floats;
  if (!hasObject(object)) throw Error("setBounds: " + idText("object", object) + " does not exist");
  Box box = boxOf("setBounds", world);
  double largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(box.lo[k]), std::abs(box.hi[k])});
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= kBoundsRoom * largest;
    box.hi[k] += kBoundsRoom * largest;
  }
  impl_->bounds[object] = box;
  impl_->change(object);
  impl_->boundsVersion = impl_->poseVersion;
}

void Scene::removeObject(ObjectId object) {
  const FloatEnvironment floats;
  if (!hasObject(object)) throw Error("removeObject: " + idText("object", object) + " does not exist");
  impl_->freeObjects.push(object);
  impl_->bounds.erase(object);
  impl_->moving -= isMoving(impl_->objects[object].object);
  --impl_->meshes[impl_->objects[object].object.mesh].objects;
  impl_->objects[object] = {};
  impl_->change(object);
  impl_->structureVersion = impl_->poseVersion;
}

bool Scene::hasMesh(MeshId mesh) const {
  return mesh < impl_->meshes.size() && impl_->meshes[mesh].used;
}

bool Scene::hasObject(ObjectId object) const {
  return object < impl_->objects.size() && impl_->objects[object].used;
}

MeshView Scene::mesh(MeshId mesh) const {
  if (!hasMesh(mesh)) throw Error("mesh: " + idText("mesh", mesh) + " does not exist");
  return {impl_->meshes[mesh].positions, impl_->meshes[mesh].indices};
}

const Object& Scene::object(ObjectId object) const {
  if (!hasObject(object)) throw Error("object: " + idText("object", object) + " does not exist");
  return impl_->objects[object].object;
}

MeshId Scene::meshLimit() const {
  return static_cast<MeshId>(impl_->meshes.size());
}

ObjectId Scene::objectLimit() const {
  return static_cast<ObjectId>(impl_->objects.size());
}

uint64_t Scene::version() const {
  return std::max(impl_->meshVersion, impl_->poseVersion);
}

}  // namespace radar
