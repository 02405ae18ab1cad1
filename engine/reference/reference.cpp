#include "reference/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "exact/common_point.h"
#include "reference/search.h"

namespace radar::reference {

namespace {

/// Tells whether the memory behind a mesh id still holds the same mesh.
uint64_t fingerprint(const MeshView& mesh) {
  uint64_t lanes[4] = {mesh.positions.size(), mesh.indices.size(), 1, 2};
  size_t at = 0;
  const auto mix = [&](uint32_t word) {
    uint64_t& lane = lanes[at++ % 4];
    lane = std::rotl(lane ^ word, 23) * 0x9e3779b97f4a7c15u;
  };
  for (float value : mesh.positions) mix(std::bit_cast<uint32_t>(value));
  for (uint32_t index : mesh.indices) mix(index);
  return lanes[0] ^ std::rotl(lanes[1], 16) ^ std::rotl(lanes[2], 32) ^ std::rotl(lanes[3], 48);
}

Bounds<double> worldBounds(const TreeMesh& mesh, const Pose& pose) {
  const auto& root = mesh.tree.nodes()[0];
  Bounds<double> box;
  for (int row = 0; row < 3; ++row) {
    const double* m = &pose.m[4 * row];
    double middle = m[3], half = 0, magnitude = std::abs(m[3]);
    for (int k = 0; k < 3; ++k) {
      middle += m[k] * (0.5 * (double(root.lo[k]) + root.hi[k]));
      half += std::abs(m[k]) * (0.5 * (double(root.hi[k]) - root.lo[k]));
      magnitude += std::abs(m[k]) * mesh.extent[k];
    }
    half += 16 * kUnit * magnitude;
    box.lo[row] = middle - half;
    box.hi[row] = middle + half;
  }
  return box;
}

}  // namespace

struct Reference::Impl {
  struct KnownMesh {
    uint64_t fingerprint = 0;
    std::unique_ptr<TreeMesh> tree;
  };

  const Scene& scene;
  uint64_t version = ~uint64_t{0};
  std::vector<KnownMesh> meshes;
  World world;
  double areaWhenBuilt = 0;
  Search search{world};

  explicit Impl(const Scene& s) : scene(s) {}

  void sync();
  void syncMeshes();
  void syncObjects();
  const TreeMesh& mesh(MeshId id);
  Result answer(const Query& query);
};

void Reference::Impl::sync() {
  if (version == scene.version()) return;
  syncMeshes();
  syncObjects();
  version = scene.version();
}

void Reference::Impl::syncMeshes() {
  meshes.resize(scene.meshLimit());
  for (MeshId id = 0; id < meshes.size(); ++id) {
    KnownMesh& known = meshes[id];
    if (!known.tree) continue;
    if (!scene.hasMesh(id) || fingerprint(scene.mesh(id)) != known.fingerprint) {
      known = {};
    } else {
      known.tree->mesh = scene.mesh(id);
    }
  }
}

const TreeMesh& Reference::Impl::mesh(MeshId id) {
  KnownMesh& known = meshes[id];
  if (!known.tree) {
    const MeshView view = scene.mesh(id);
    known = {fingerprint(view), std::make_unique<TreeMesh>(view)};
  }
  return *known.tree;
}

void Reference::Impl::syncObjects() {
  std::vector<World::Placed> now;
  now.reserve(world.objects.size());
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!scene.hasObject(id)) continue;
    const Object& object = scene.object(id);
    now.push_back({id, &mesh(object.mesh), object});
  }
  const bool sameItems = std::equal(now.begin(), now.end(), world.objects.begin(), world.objects.end(),
                                    [](const World::Placed& p, const World::Placed& q) { return p.id == q.id; });
  world.objects = std::move(now);

  std::vector<Bounds<double>> boxes(world.objects.size());
  world.extent = {};
  for (size_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = worldBounds(*world.objects[i].mesh, world.objects[i].object.worldFromMesh);
    for (int k = 0; k < 3; ++k) {
      world.extent[k] = std::max({world.extent[k], std::abs(boxes[i].lo[k]), std::abs(boxes[i].hi[k])});
    }
  }
  // Moved objects keep their place in the tree until that has spoilt it.
  if (sameItems) {
    world.tree.refit(boxes);
    if (world.tree.area() <= 1.5 * areaWhenBuilt) return;
  }
  world.tree.build(boxes, 1);
  areaWhenBuilt = world.tree.area();
}

Result Reference::Impl::answer(const Query& query) {
  if (std::string wrong = whatIsWrong(query, scene); !wrong.empty()) throw Error("reference: " + wrong);
  const Best& best = search.find(query, mesh(query.mesh));
  Result result;
  result.tier = Tier::reference;
  result.status = Status::clear;
  if (!best.found) return result;
  if (query.decide) {
    result.status = Status::hit;
    result.detected = Detected::yes;
    result.lo = 0;
    result.hi = best.latest;
    return result;
  }

  result.status = best.overlap ? Status::overlap : Status::hit;
  result.detected = Detected::yes;
  result.object = best.object;
  result.triB = best.triB;
  result.triA = best.triA;
  result.t = result.lo = result.hi = result.fraction = 0;
  const double s = best.overlap ? 0 : exact::parameter(best.event);
  const bool touching = !best.overlap || exact::sign(best.event) == 0;
  if (touching) {
    result.point = exact::point(best.event, s);
    result.normal = exact::normal(best.event);
  } else {
    result.point = exact::commonPoint(best.a, best.b);
  }
  if (best.overlap) return result;

  const double distance = query.distance, t = s * search.length();
  const bool atEnd = exact::compareToDistance(best.event, distance) == 0;
  result.t = atEnd ? distance : std::min(t, distance);
  // Three roundings of half an ulp each, of the parameter, the length and the product, and one more here; the floor is
  // what the parameter may lose where it is subnormal.
  const double slack = 8 * kUnit * t + (search.length() + 2) * std::numeric_limits<double>::denorm_min();
  result.lo = atEnd ? distance : std::max(t - slack, 0.0);
  result.hi = std::min(t + slack, distance);
  result.lo = std::min(result.lo, result.t);
  result.fraction = result.t / distance;
  return result;
}

Reference::Reference(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Reference::~Reference() = default;

void Reference::sync() {
  impl_->sync();
}

Result Reference::answer(const Query& query) {
  impl_->sync();
  return impl_->answer(query);
}

std::vector<Result> Reference::run(std::span<const Query> queries) {
  impl_->sync();
  std::vector<Result> results;
  results.reserve(queries.size());
  for (const Query& query : queries) results.push_back(impl_->answer(query));
  return results;
}

uint64_t Reference::pairs() const {
  return impl_->search.pairs();
}

uint64_t Reference::exactPairs() const {
  return impl_->search.exactPairs();
}

}  // namespace radar::reference
