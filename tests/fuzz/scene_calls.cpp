#include "fuzz/scene_calls.h"

#include <algorithm>
#include <cmath>

#include "fuzz/target.h"
#include "workloads/shapes.h"

namespace radar::fuzz {

namespace {

constexpr double kMostBound = 0x1p120, kMostMotion = 0x1p1000;

bool areFinite(const auto& numbers) {
  return std::ranges::all_of(numbers, [](auto x) { return std::isfinite(x); });
}

bool areAtMost(const auto& numbers, double most) {
  return std::ranges::all_of(numbers, [&](auto x) { return std::abs(x) <= most; });
}

bool isValid(const Bounds& bounds) {
  for (size_t k = 0; k < 3; ++k) {
    if (!(bounds.lo[k] <= bounds.hi[k])) return false;
  }
  return areAtMost(bounds.lo, kMostBound) && areAtMost(bounds.hi, kMostBound);
}

/// The bounds, made to hold the vertices of triangles.
Bounds around(Bounds bounds, const std::vector<float>& positions, const std::vector<uint32_t>& indices) {
  for (const uint32_t vertex : indices) {
    for (size_t k = 0; k < 3; ++k) {
      bounds.lo[k] = std::min(bounds.lo[k], double{positions[3 * size_t{vertex} + k]});
      bounds.hi[k] = std::max(bounds.hi[k], double{positions[3 * size_t{vertex} + k]});
    }
  }
  return bounds;
}

bool areInside(const Bounds& bounds, const std::vector<float>& positions, const std::vector<uint32_t>& indices) {
  const Bounds grown = around(bounds, positions, indices);
  return grown.lo == bounds.lo && grown.hi == bounds.hi;
}

/// The least number that is no key.
uint32_t leastFree(const auto& items) {
  uint32_t id = 0;
  for (const auto& [used, item] : items) id += used == id;
  return id;
}

}  // namespace

bool SceneCalls::call(const char* name, bool valid, const std::function<void()>& edit) const {
  bool thrown = false;
  const uint64_t version = scene_.version();
  try {
    edit();
  } catch (const Error& error) {
    thrown = true;
    require(std::string_view(error.what()).starts_with(name), std::string("not named after the call: ") + error.what());
    require(scene_.version() == version, "a refused edit that changed the scene");
  }
  require(thrown != valid, std::string(name) + (valid ? ": refused" : ": accepted"));
  return valid;
}

template <class Items>
uint32_t SceneCalls::idOf(const Items& items) {
  if (items.empty() || choices_.oneIn(32)) return choices_.oneIn(2) ? choices_.raw<uint32_t>() : choices_.below(8);
  return std::next(items.begin(), choices_.below(static_cast<uint32_t>(items.size())))->first;
}

test::SceneModel::Mesh SceneCalls::mesh() {
  Mesh mesh;
  if (choices_.oneIn(3)) {
    const tools::MeshData box = tools::makeBox({2, 2, 2});
    return {box.positions, box.indices};
  }
  const uint32_t vertices = 1 + choices_.below(9), triangles = choices_.oneIn(32) ? 0 : 1 + choices_.below(6);
  for (uint32_t i = 0; i < 3 * vertices; ++i) mesh.positions.push_back(choices_.number<float>(wild_));
  for (uint32_t i = 0; i < 3 * triangles; ++i) mesh.indices.push_back(choices_.below(vertices));
  if (choices_.oneIn(32)) mesh.positions.pop_back();
  if (choices_.oneIn(32)) mesh.indices.push_back(choices_.raw<uint32_t>());
  if (choices_.oneIn(32)) mesh.indices.assign(3, vertices);
  return mesh;
}

Bounds SceneCalls::bounds() {
  if (choices_.oneIn(2)) return {{-8, -8, -8}, {8, 8, 8}};
  return {vector(), vector()};
}

Transform SceneCalls::pose() {
  Transform pose;
  const uint32_t kind = choices_.below(4);
  if (kind == 3) {
    for (double& entry : pose.m) entry = number();
    return pose;
  }
  if (kind > 0) {
    // A permutation of the axes, scaled and mirrored.
    const uint32_t first = choices_.below(3), swapped = choices_.below(2);
    for (uint32_t row = 0; row < 3; ++row) {
      const uint32_t column = (first + (swapped == 0 ? row : 3 - row)) % 3;
      for (uint32_t k = 0; k < 3; ++k) pose.m[4 * row + k] = k == column ? (kind == 1 ? 1 : number()) : 0;
    }
  }
  const std::array<double, 3> at = vector();
  for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] = at[k];
  return pose;
}

std::array<double, 3> SceneCalls::motion() {
  return moving_ && choices_.oneIn(2) ? vector() : std::array<double, 3>{};
}

void SceneCalls::addMesh() {
  Mesh mesh = this->mesh();
  std::optional<Bounds> declared;
  if (choices_.oneIn(8)) declared = bounds();
  const size_t vertices = mesh.positions.size() / 3;
  const bool valid = mesh.positions.size() % 3 == 0 && mesh.indices.size() % 3 == 0 && !mesh.indices.empty() &&
                     areFinite(mesh.positions) &&
                     std::ranges::all_of(mesh.indices, [&](uint32_t i) { return i < vertices; }) &&
                     (!declared || (isValid(*declared) && areAtMost(mesh.positions, kMostBound)));
  const MeshId expected = leastFree(model_.meshes);
  MeshId id = kNone;
  if (!call("addMesh", valid, [&] { id = scene_.addMesh(mesh.positions, mesh.indices, declared); })) return;
  require(id == expected, "not the least free number of a mesh");
  if (declared) mesh.bounds = around(*declared, mesh.positions, mesh.indices);
  model_.meshes[id] = std::move(mesh);
}

void SceneCalls::setPositions() {
  const MeshId id = idOf(model_.meshes);
  const auto found = model_.meshes.find(id);
  std::vector<float> positions(found == model_.meshes.end() ? 9
                                                            : found->second.positions.size() + 3 * choices_.oneIn(16));
  for (float& x : positions) x = choices_.number<float>(wild_);
  const bool valid = found != model_.meshes.end() && areFinite(positions) &&
                     positions.size() == found->second.positions.size() &&
                     (!found->second.bounds || areInside(*found->second.bounds, positions, found->second.indices));
  if (call("setPositions", valid, [&] { scene_.setPositions(id, positions); })) found->second.positions = positions;
}

void SceneCalls::removeMesh() {
  const MeshId id = idOf(model_.meshes);
  const bool valid = model_.meshes.contains(id) &&
                     std::ranges::none_of(model_.objects, [&](const auto& item) { return item.second.mesh == id; });
  if (call("removeMesh", valid, [&] { scene_.removeMesh(id); })) model_.meshes.erase(id);
}

void SceneCalls::addObject() {
  const Object object{idOf(model_.meshes), pose(), choices_.oneIn(4) ? choices_.below(4) : ~0u, motion()};
  const bool valid = model_.meshes.contains(object.mesh) && validate(object.worldFromMesh).empty() &&
                     areAtMost(object.motion, kMostMotion);
  require(areFinite(object.worldFromMesh.m) || !validate(object.worldFromMesh).empty(), "a pose that is not finite");
  const ObjectId expected = leastFree(model_.objects);
  ObjectId id = kNone;
  if (!call("addObject", valid, [&] { id = scene_.addObject(object); })) return;
  require(id == expected, "not the least free number of an object");
  model_.objects[id] = object;
}

void SceneCalls::editObject() {
  const ObjectId id = idOf(model_.objects);
  const auto found = model_.objects.find(id);
  const bool exists = found != model_.objects.end();
  switch (choices_.below(4)) {
    case 0: {
      const Transform moved = pose();
      const bool valid = exists && validate(moved).empty();
      if (call("setTransform", valid, [&] { scene_.setTransform(id, moved); })) found->second.worldFromMesh = moved;
      break;
    }
    case 1: {
      const std::array<double, 3> step = motion();
      const bool valid = exists && areAtMost(step, kMostMotion);
      if (call("setMotion", valid, [&] { scene_.setMotion(id, step); })) found->second.motion = step;
      break;
    }
    case 2: {
      const Bounds within = bounds();
      call("setBounds", exists && isValid(within), [&] { scene_.setBounds(id, within); });
      break;
    }
    default:
      if (call("removeObject", exists, [&] { scene_.removeObject(id); })) model_.objects.erase(id);
  }
}

void SceneCalls::edit() {
  const uint32_t kind = model_.meshes.empty() ? 0 : choices_.below(8);
  if (kind == 0) {
    addMesh();
  } else if (kind == 1) {
    setPositions();
  } else if (kind == 2) {
    removeMesh();
  } else if (kind < 6) {
    addObject();
  } else {
    editObject();
  }
  checkModel();
}

void SceneCalls::checkModel() const {
  require(test::SceneModel::of(scene_) == model_, "not the scene that the edits make");
  require(!scene_.hasMesh(scene_.meshLimit()) && !scene_.hasObject(scene_.objectLimit()),
          "something beyond the limits");
}

/// At the origin of an object, or beside it.
void SceneCalls::aim(Query& query, ObjectId object) {
  if (!model_.objects.contains(object)) return;
  const std::array<double, 3> beside = query.direction;
  for (size_t k = 0; k < 3; ++k) {
    query.direction[k] = model_.objects.at(object).worldFromMesh.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
    if (choices_.oneIn(4)) query.direction[k] += beside[k];
  }
  query.distance =
      choices_.of(std::array{0.5, 1.0, 4.0}) * std::hypot(query.direction[0], query.direction[1], query.direction[2]);
}

Query SceneCalls::query() {
  Query query{.mesh = idOf(model_.meshes), .worldFromMesh = pose()};
  query.direction = vector();
  query.distance = std::abs(number());
  if (!model_.objects.empty() && !choices_.oneIn(4)) aim(query, idOf(model_.objects));
  if (moving_ && choices_.oneIn(2)) {
    query.motion = query.direction;
    query.direction = {};
    query.distance = 0;
  }
  if (choices_.oneIn(8)) query.mask = choices_.below(4);
  for (uint32_t count = choices_.oneIn(8) ? choices_.below(200) : 0; count > 0; --count) {
    query.exclude.push_back(idOf(model_.objects));
  }
  switch (choices_.below(8)) {
    case 7:
      query.anyHit = true;
      break;
    case 6:
      query.hits = choices_.of(std::array{0u, 1u, 2u, 3u, 1u << 31, kAllHits});
      break;
    case 5:
      query.clearance = number();
      if (choices_.oneIn(2)) query.tolerance = number();
      break;
    default:
      break;
  }
  query.ignoreLeaving = choices_.oneIn(4);
  query.skipOverlapping = choices_.oneIn(6);
  query.closest = choices_.oneIn(8);
  query.exit = choices_.oneIn(8);
  // Brute force does not know the bounds of meshes, on which the default depends.
  const bool hasBounds =
      std::ranges::any_of(model_.meshes, [](const auto& mesh) { return mesh.second.bounds.has_value(); });
  if (query.ignoreLeaving || query.skipOverlapping) {
    if (hasBounds) query.slack = 0;
    if (choices_.oneIn(2)) query.slack = number();
  }
  if (choices_.oneIn(64)) query.anyHit = !query.anyHit;
  if (choices_.oneIn(16)) query.resolution = choices_.below(4096);
  if (choices_.oneIn(64)) query.distance = number();
  return query;
}

std::vector<Query> SceneCalls::queries(uint32_t most) {
  std::vector<Query> queries(choices_.below(most + 1));
  for (Query& query : queries) query = this->query();
  return queries;
}

}  // namespace radar::fuzz
