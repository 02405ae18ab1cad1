#include "scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <optional>

#include "math/float_environment.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Bounds are widened by this part of their largest coordinate, so that float arithmetic does not leave them.
constexpr double kBoundsRoom = 0x1p-18;

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

size_t isMoving(const Object& object) {
  return object.motion == Vector{} ? 0 : 1;
}

}  // namespace

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

MeshId Scene::Impl::add(Mesh mesh) {
  mesh.version = nextVersion();
  auto id = static_cast<MeshId>(meshes.size());
  if (freeMeshes.empty()) {
    meshes.push_back(std::move(mesh));
  } else {
    id = freeMeshes.top();
    freeMeshes.pop();
    meshes[id] = std::move(mesh);
  }
  meshVersion = nextVersion();
  return id;
}

MeshId Scene::addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                      const std::optional<Bounds>& bounds) {
  const FloatEnvironment floats;
  return impl_->add(makeMesh(positions, indices, bounds));
}

MeshId Scene::addCutter(const Cutter& cutter) {
  const FloatEnvironment floats;
  std::vector<RingHull> parts = hullsOf(cutter);
  const DrawnCutter shown = drawn(parts);
  Mesh mesh = makeMesh(shown.positions, shown.indices, std::nullopt);
  mesh.parts = std::move(parts);
  return impl_->add(std::move(mesh));
}

void Scene::setPositions(MeshId id, std::span<const float> positions) {
  const FloatEnvironment floats;
  if (!hasMesh(id)) throw Error("setPositions: " + idText("mesh", id) + " does not exist");
  Mesh& mesh = impl_->meshes[id];
  if (!mesh.parts.empty()) throw Error("setPositions: " + idText("mesh", id) + " is a cutter");
  movePositions(mesh, positions);
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
  if (!impl_->meshes[object.mesh].parts.empty()) {
    throw Error("addObject: " + idText("mesh", object.mesh) + " is a cutter, which only queries move");
  }
  if (std::string wrong = validate(object.worldFromMesh); !wrong.empty()) throw Error("addObject: pose: " + wrong);
  if (std::string wrong = validateMotion(object.motion); !wrong.empty()) throw Error("addObject: motion: " + wrong);
  if (impl_->freeObjects.empty()) requireAtMost("addObject", "objects", impl_->objects.size() + 1, kMostItems);
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
