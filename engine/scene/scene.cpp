#include "scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "math/rounding.h"

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
                  std::to_string(bounds.lo[k]) + " and " + std::to_string(bounds.hi[k]));
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
  float largest = 0;
  for (int k = 0; k < 3; ++k) {
    mesh.farthest[k] = std::max(std::abs(box.lo[k]), std::abs(box.hi[k]));
    mesh.origin[k] = originOf(box.lo[k], box.hi[k]);
    mesh.box.lo[k] = box.lo[k] - mesh.origin[k];
    mesh.box.hi[k] = box.hi[k] - mesh.origin[k];
    const double reach = std::max(std::abs(mesh.box.lo[k]), std::abs(mesh.box.hi[k]));
    mesh.reach[k] = roundUp(reach);
    largest = std::max(largest, mesh.reach[k]);
    const double used = mesh.positions[3 * size_t{mesh.indices[0]} + k];
    mesh.local[k].assign(mesh.vertexCount(), static_cast<float>(used - mesh.origin[k]));
  }
  mesh.unit = largest > 0 ? std::ldexp(1.0, std::max(std::ilogb(largest), kLeastUnit)) : 1;
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

template <class Slots>
uint32_t takeSlot(Slots& slots, FreeIds& free) {
  if (free.empty()) {
    slots.emplace_back();
    return static_cast<uint32_t>(slots.size() - 1);
  }
  const uint32_t id = free.top();
  free.pop();
  return id;
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

size_t isMoving(const Object& object) {
  return object.motion == Vector{} ? 0 : 1;
}

}  // namespace

Box boxOf(const Mesh& mesh, const std::array<double, 12>& m) {
  std::array<double, 12> parentFromLocal = m;
  double magnitude = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) {
      parentFromLocal[4 * row + 3] += r[k] * mesh.origin[k];
      sum += std::abs(r[k]) * (std::abs(mesh.origin[k]) + mesh.reach[k]);
    }
    magnitude = std::max(magnitude, sum);
  }
  Box box = boxOfLocal(mesh, parentFromLocal);
  for (int row = 0; row < 3; ++row) {
    box.lo[row] -= 0x1p-47 * magnitude;
    box.hi[row] += 0x1p-47 * magnitude;
  }
  return box;
}

Box boxOfLocal(const Mesh& mesh, const std::array<double, 12>& m) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    double middle = r[3], half = 0;
    for (int k = 0; k < 3; ++k) {
      middle += r[k] * mesh.box.middle(k);
      half += std::abs(r[k]) * 0.5 * (mesh.box.hi[k] - mesh.box.lo[k]);
    }
    box.lo[row] = middle - half;
    box.hi[row] = middle + half;
  }
  return box;
}

double determinant(const Transform& pose) {
  const std::array<double, 12>& m = pose.m;
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

Vector transformPoint(const Transform& pose, const float* p) {
  const double x = p[0], y = p[1], z = p[2];
  Vector out;
  for (int k = 0; k < 3; ++k) {
    const double* r = &pose.m[4 * k];
    out[k] = ((r[0] * x + r[1] * y) + r[2] * z) + r[3];
  }
  return out;
}

std::array<Vector, 3> placedTriangle(const Mesh& mesh, const Transform& worldFromMesh, uint32_t triangle) {
  std::array<Vector, 3> corners;
  for (size_t i = 0; i < 3; ++i) {
    const size_t vertex = mesh.indices[3 * size_t{triangle} + i];
    corners[i] = transformPoint(worldFromMesh, &mesh.positions[3 * vertex]);
  }
  return corners;
}

double placedMagnitude(const Vector& farthest, const Transform& worldFromMesh) {
  double greatest = 0;
  for (int i = 0; i < 3; ++i) {
    const double* row = &worldFromMesh.m[4 * i];
    double sum = std::abs(row[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(row[k]) * farthest[k];
    greatest = std::max(greatest, sum);
  }
  return std::min(greatest, std::numeric_limits<double>::max());
}

Scene::Impl::Impl() : identity(nextVersion()) {}

const ObjectTree& Scene::Impl::objectTree() const {
  const std::scoped_lock lock(treeMutex_);
  tree_.update(*this, treeChanges_);
  treeChanges_.objects.clear();
  treeChanges_.areMany = false;
  return tree_;
}

void Scene::Impl::change(ObjectId object) {
  poseVersion = changedAt[object] = nextVersion();
  changedObjects.mark(object, poseVersion);
  treeChanges_.areMany = treeChanges_.areMany || treeChanges_.objects.size() > kFewChanges + objects.size() / 16;
  if (!treeChanges_.areMany) treeChanges_.objects.push_back(object);
}

Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

MeshId Scene::addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                      const std::optional<Bounds>& bounds) {
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
  mesh.deforms = bounds.has_value();
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
  const MeshId id = takeSlot(impl_->meshes, impl_->freeMeshes);
  impl_->meshes[id] = std::move(mesh);
  impl_->meshVersion = nextVersion();
  return id;
}

void Scene::setPositions(MeshId id, std::span<const float> positions) {
  if (!hasMesh(id)) throw Error("setPositions: " + idText("mesh", id) + " does not exist");
  Mesh& mesh = impl_->meshes[id];
  if (mesh.deforms) throw Error("setPositions: " + idText("mesh", id) + " has bounds: its host moves its vertices");
  if (positions.size() != mesh.positions.size()) {
    throw Error("setPositions: expected " + std::to_string(mesh.positions.size()) + " floats, 3 for each vertex, got " +
                std::to_string(positions.size()));
  }
  requireFinite("setPositions", positions);
  std::ranges::copy(positions, mesh.positions.begin());
  derive(mesh, {});
  mesh.tree = refitMeshTree(mesh, std::move(mesh.tree));
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
  impl_->meshes[mesh] = Mesh{};
  impl_->freeMeshes.push(mesh);
  impl_->meshVersion = nextVersion();
}

ObjectId Scene::addObject(const Object& object) {
  if (!hasMesh(object.mesh)) throw Error("addObject: " + idText("mesh", object.mesh) + " does not exist");
  if (std::string wrong = validate(object.worldFromMesh); !wrong.empty()) throw Error("addObject: pose: " + wrong);
  if (std::string wrong = validateMotion(object.motion); !wrong.empty()) throw Error("addObject: motion: " + wrong);
  if (impl_->freeObjects.empty()) requireAtMost("addObject", "objects", impl_->objects.size() + 1, kMostObjects);
  const ObjectId id = takeSlot(impl_->objects, impl_->freeObjects);
  impl_->objects[id] = {object, true};
  ++impl_->meshes[object.mesh].objects;
  impl_->moving += isMoving(object);
  impl_->changedAt.resize(impl_->objects.size());
  impl_->changedObjects.resize(impl_->objects.size());
  impl_->change(id);
  impl_->structureVersion = impl_->poseVersion;
  return id;
}

void Scene::setTransform(ObjectId object, const Transform& worldFromMesh) {
  if (!hasObject(object)) throw Error("setTransform: " + idText("object", object) + " does not exist");
  if (std::string wrong = validate(worldFromMesh); !wrong.empty()) throw Error("setTransform: " + wrong);
  impl_->objects[object].object.worldFromMesh = worldFromMesh;
  impl_->change(object);
}

void Scene::setMotion(ObjectId object, const std::array<double, 3>& motion) {
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
}

void Scene::removeObject(ObjectId object) {
  if (!hasObject(object)) throw Error("removeObject: " + idText("object", object) + " does not exist");
  impl_->bounds.erase(object);
  impl_->moving -= isMoving(impl_->objects[object].object);
  --impl_->meshes[impl_->objects[object].object.mesh].objects;
  impl_->objects[object] = {};
  impl_->freeObjects.push(object);
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
