// The search's bounds admit pairs that touch by construction: a vertex of the sensor meets a vertex of an object.
// Sizes, distances and positions vary widely.
#include <algorithm>
#include <cmath>

#include "cpu/approach.h"
#include "exact/translation.h"
#include "gpu/contact_margins_interop.h"
#include "gpu/kernel_fixture.h"
#include "math/rounding.h"
#include "scene/gpu_scene.h"
#include "support/catch.h"
#include "support/encoded.h"
#include "support/world.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::add;
using test::PairBounds;
using test::Touch;

using Real = long double;
using Place = std::array<Real, 3>;

Place placed(const Transform& pose, const std::array<double, 3>& p) {
  Place out;
  for (int k = 0; k < 3; ++k) {
    out[k] = pose.m[4 * k + 3];
    for (int j = 0; j < 3; ++j) out[k] += Real(pose.m[4 * k + j]) * p[j];
  }
  return out;
}

std::array<double, 3> vertex(const Mesh& mesh, uint32_t v) {
  return {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
}

double magnitude(tools::Random& random, double mostExponent) {
  return std::exp2(random.uniform(-mostExponent, mostExponent));
}

/// Rotates the mesh's own coordinates, which are rounded to floats.
tools::MeshData turned(tools::MeshData mesh, tools::Random& random) {
  const Transform pose = tools::makePose(random.rotation(), {1, 0.3, 1.7}, {0.1, 5, -30});
  for (size_t v = 0; v < mesh.positions.size(); v += 3) {
    const std::array<double, 3> p = transformPoint(pose, &mesh.positions[v]);
    for (int k = 0; k < 3; ++k) mesh.positions[v + k] = static_cast<float>(p[k]);
  }
  return mesh;
}

/// Scales the mesh by `by` along its own z axis.
tools::MeshData flattened(tools::MeshData mesh, float by) {
  for (size_t k = 2; k < mesh.positions.size(); k += 3) mesh.positions[k] *= by;
  return mesh;
}

/// A pair of triangles that touch.
struct Case {
  Query query;
  ObjectId object;
  uint32_t triangleA, triangleB;
  Real contact;  ///< distance at which they touch, within `doubt`
  Real doubt;    ///< error of placing them in double precision
  double clearance;
  std::optional<cpu::Approach> nearing;  ///< when they come that near
};

class Margins {
 public:
  explicit Margins(uint64_t seed) : random_(seed), gpuScene_(test::impl()) {
    const std::vector<MeshId> meshes = addMeshes();
    for (int i = 0; i < 48; ++i) {
      const double far = random_.oneIn(3) ? magnitude(random_, 20) : 1;
      Transform pose = poseOf(magnitude(random_, 12), far);
      scene_.addObject({meshes[random_.below(static_cast<uint32_t>(meshes.size()))], pose, ~0u});
    }
    for (int i = 0; i < 400; ++i) addCase(meshes[random_.below(static_cast<uint32_t>(meshes.size()))]);
  }

  /// Checks all bounds for every case and every pair of nodes above its triangles.
  void check();

 private:
  std::vector<MeshId> addMeshes() {
    std::vector<MeshId> meshes;
    const auto keep = [&](const tools::MeshData& mesh) { meshes.push_back(add(scene_, mesh)); };
    keep(tools::makeBox({1, 2, 0.5}));
    keep(turned(tools::makeBox({1, 1, 1}), random_));
    keep(turned(tools::makeBox({1, 1e-4, 3}), random_));
    keep(turned(tools::makeRod(1, 40, 7), random_));
    keep(tools::makeSheet(6, 0.05, random_));
    keep(flattened(tools::makeSheet(6, 0.5, random_), 1e-3));
    keep(flattened(turned(tools::makeRod(1, 3, 7), random_), 1e-5));
    for (const tools::Soup soup : tools::kSoups) keep(tools::makeSoup(soup, 20, random_));
    return meshes;
  }

  /// A random pose of size `size`, up to `far` times its size from the origin.
  Transform poseOf(double size, double far) {
    Transform pose = tools::makePose(random_.rotation(), {1, 1, 1}, {});
    if (random_.oneIn(2)) pose = random_.affine({});
    if (random_.oneIn(6))
      pose = tools::makePose(random_.rotation(), {1, magnitude(random_, 14), magnitude(random_, 14)}, {});
    if (random_.oneIn(4)) pose = Transform();
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) pose.m[4 * row + k] *= size;
      pose.m[4 * row + 3] = size * far * random_.uniform(-1, 1);
    }
    return pose;
  }

  void addCase(MeshId meshId) {
    const Scene::Impl& impl = scene_.impl();
    Case c;
    c.object = random_.below(static_cast<uint32_t>(impl.objects.size()));
    const Object& object = impl.objects[c.object].object;
    const Mesh &a = impl.meshes[meshId], &b = impl.meshes[object.mesh];
    c.query.mesh = meshId;
    double size = 0;
    for (int k = 0; k < 3; ++k) size = std::max(size, std::abs(object.worldFromMesh.m[k]) * b.unit);
    c.query.worldFromMesh = poseOf(size / a.unit * magnitude(random_, 10), 0);
    const Vec axis = random_.direction();
    c.query.direction = axis;
    if (random_.oneIn(3)) {
      c.query.direction = {0, 0, 0};
      c.query.direction[random_.below(3)] = random_.oneIn(2) ? 1 : -1;
    }
    for (double& x : c.query.direction) x *= size;
    Real length = 0;
    for (const double x : c.query.direction) length += Real(x) * x;
    length = std::sqrt(length);
    c.contact = random_.oneIn(4) ? 0 : size * magnitude(random_, 10);
    c.triangleA = random_.below(a.triangleCount());
    c.triangleB = random_.below(b.triangleCount());
    const Place from = placed(c.query.worldFromMesh, vertex(a, a.indices[3 * c.triangleA + random_.below(3)]));
    const Place to = placed(object.worldFromMesh, vertex(b, b.indices[3 * c.triangleB + random_.below(3)]));
    for (int k = 0; k < 3; ++k) {
      c.query.worldFromMesh.m[4 * k + 3] =
          static_cast<double>(to[k] - from[k] - c.contact * c.query.direction[k] / length);
    }
    c.query.distance = static_cast<double>(c.contact) * random_.uniform(1, 2) + size * 1e-6;
    Real spanA = 0, spanB = 0;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        spanA += std::abs(c.query.worldFromMesh.m[4 * k + j]) * (std::abs(a.origin[j]) + a.reach[j]);
        spanB += std::abs(object.worldFromMesh.m[4 * k + j]) * (std::abs(b.origin[j]) + b.reach[j]);
      }
      spanB += std::abs(object.worldFromMesh.m[4 * k + 3]);
    }
    c.doubt = 0x1p-50L * (spanA + spanB + c.contact);
    c.clearance = size * magnitude(random_, 10);
    const Translation motion(c.query);
    c.nearing = cpu::approach(placedTriangle(a, c.query.worldFromMesh, c.triangleA),
                              placedTriangle(b, object.worldFromMesh, c.triangleB), motion, c.clearance, 0, INFINITY);
    cases_.push_back(c);
  }

  using Vec = std::array<double, 3>;
  tools::Random random_;
  Scene scene_;
  GpuScene gpuScene_;
  std::vector<Case> cases_;
};

/// The orthonormal frame along the motion that is closest to the sensor's frame of floats.
std::array<Place, 3> frameOf(const gpu::Sensor& sensor, const std::array<double, 3>& direction) {
  const auto dot = [](const Place& p, const Place& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  const auto unit = [&](Place p) {
    const Real length = std::sqrt(dot(p, p));
    for (Real& x : p) x /= length;
    return p;
  };
  const Place z = unit({direction[0], direction[1], direction[2]});
  Place x{sensor.across[0], sensor.across[1], sensor.across[2]};
  const Real along = dot(x, z);
  for (int k = 0; k < 3; ++k) x[k] -= along * z[k];
  x = unit(x);
  return {x, Place{z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]}, z};
}

/// The largest error of a triangle's placed corners on any axis, scaled.
Real offBy(const float (&corners)[3][3], const Mesh& mesh, uint32_t triangle, const Transform& pose,
           const Place& anchor, const std::array<Place, 3>& frame, Real scale) {
  Real most = 0;
  for (int i = 0; i < 3; ++i) {
    const Place p = placed(pose, vertex(mesh, mesh.indices[3 * triangle + i]));
    for (int k = 0; k < 3; ++k) {
      Real at = 0;
      for (int j = 0; j < 3; ++j) at += frame[k][j] * (p[j] - anchor[j]) * scale;
      most = std::max(most, std::abs(at - corners[i][k]));
    }
  }
  return most;
}

/// The nodes from the root to the leaf of a triangle.
std::vector<uint32_t> pathTo(const MeshTree& tree, uint32_t triangle) {
  std::vector<uint32_t> path{0};
  const auto holds = [&](uint32_t node) {
    for (uint32_t i = 0; i < tree.below[node].count; ++i) {
      if (tree.order[tree.below[node].first + i] == triangle) return true;
    }
    return false;
  };
  while ((tree.nodes[path.back()].link & gpu::kLinkLeaf) == 0) {
    const uint32_t left = tree.nodes[path.back()].link;
    path.push_back(holds(left) ? left : left + 1);
  }
  return path;
}

uint32_t slotOf(const MeshTree& tree, uint32_t triangle) {
  return static_cast<uint32_t>(std::find(tree.order.begin(), tree.order.end(), triangle) - tree.order.begin());
}

uint32_t leafOf(const ObjectTree& tree, ObjectId object) {
  uint32_t node = 0;
  while (tree.nodes()[node].link != (gpu::kLinkLeaf | object)) ++node;
  return node;
}

void Margins::check() {
  const Scene::Impl& impl = scene_.impl();
  const ObjectTree& tree = impl.objectTree();
  SearchPlan batch;
  std::vector<Touch> touches;
  std::vector<const Case*> of;
  std::vector<const Case*> stated;
  for (const Case& c : cases_) {
    if (batch.add(c.query, batch.count(), impl, tree) == Planned::added) stated.push_back(&c);
  }
  const test::Encoded encoded = test::encodedBy(gpuScene_, impl, batch);
  uint32_t searched = 0;
  for (uint32_t sensor = 0; sensor < stated.size(); ++sensor) {
    if (encoded.states[sensor].flags != 0) continue;
    ++searched;
    const Case& c = *stated[sensor];
    const MeshId meshB = impl.objects[c.object].object.mesh;
    const MeshTree &treeA = impl.meshes[c.query.mesh].tree, &treeB = impl.meshes[meshB].tree;
    const gpu::MeshRecord &recordA = gpuScene_.record(c.query.mesh), &recordB = gpuScene_.record(meshB);
    const std::vector<uint32_t> pathA = pathTo(treeA, c.triangleA), pathB = pathTo(treeB, c.triangleB);
    const double scale = encoded.sensors[sensor].scale;
    const float limit = roundUp(static_cast<double>((c.contact + c.doubt) * scale));
    const float nearLimit = c.nearing && c.nearing->hi < 1e30 / scale ? roundUp(c.nearing->hi * scale) : limit;
    for (const uint32_t a : pathA) {
      for (const uint32_t b : pathB) {
        touches.push_back({sensor, c.object, recordA.firstNode + a, recordB.firstNode + b,
                           recordA.firstTriangle + slotOf(treeA, c.triangleA),
                           recordB.firstTriangle + slotOf(treeB, c.triangleB), leafOf(tree, c.object), limit,
                           roundUp(c.clearance * scale), nearLimit});
        of.push_back(&c);
      }
    }
  }
  CHECK(searched > cases_.size() / 2);

  const auto upload = [](const auto& from, auto array) {
    array.reserve(from.size());
    std::copy(from.begin(), from.end(), array.mapped());
    return array;
  };
  const auto sensors = upload(
      encoded.sensors, gpu::Array<gpu::Sensor>(test::impl(), "sensors", gpu::BufferDomain::upload, gpu::kAsTexels));
  const auto touchBuffer = upload(touches, gpu::Array<Touch>(test::impl(), "touches", gpu::BufferDomain::upload));
  gpu::Array<PairBounds> answers(test::impl(), "pair bounds", gpu::BufferDomain::readback);
  answers.reserve(touches.size());
  gpu::Passes passes(test::impl());
  const GpuScene::Buffers& scene = gpuScene_.buffers();
  const auto count = static_cast<uint32_t>(touches.size());
  test::run([&](const gpu::Commands& commands) {
    passes(commands, test::kContactMargins, gpu::groupsFor(count, 64), count,
           {{gpu::kSlotMeshNodes, scene.meshNodes},
            {gpu::kSlotObjectNodes, scene.objectNodes},
            {gpu::kSlotVertices, scene.vertices},
            {gpu::kSlotTriangles, scene.triangles},
            {gpu::kSlotPlacements, scene.placements},
            {gpu::kSlotSensors, sensors},
            {test::kSlotTouches, touchBuffer},
            {test::kSlotPairBounds, answers}});
  });

  uint32_t inRange = 0, tight = 0, tightFrom = 0, certainlyNear = 0, tightlyNear = 0;
  Real closest = 0;  // the largest error, as a fraction of its bound
  for (uint32_t i = 0; i < count; ++i) {
    const PairBounds& found = answers.mapped()[i];
    const Case& c = *of[i];
    const gpu::Sensor& sensor = encoded.sensors[touches[i].sensor];
    const Real scale = sensor.scale, contact = (c.contact + c.doubt) * scale;
    CAPTURE(i, c.query.mesh, c.object, double(c.contact), double(contact), found.gap, found.boxGap, found.boxEnd);
    if (found.inRange == 0) continue;
    ++inRange;
    // In the tree over objects.
    CHECK(found.boxGap <= c.contact + c.doubt);
    CHECK(found.boxEnd >= c.contact - c.doubt);
    // Nodes.
    CHECK(found.gap <= contact);
    tight += found.gap > 0.99L * contact;
    // Triangles.
    CHECK(found.from <= contact);
    tightFrom += found.from > 0.99L * contact;
    CHECK(found.pairGap <= contact);
    if (c.nearing && !std::isinf(c.nearing->hi)) {
      const Real from = c.nearing->lo * scale, by = touches[i].nearLimit;
      CAPTURE(c.clearance, double(from), double(by), found.nearLow, found.nearBy);
      CHECK(found.gapNear <= by);
      CHECK(found.nearFrom <= by);
      CHECK(found.nearLow <= by);
      CHECK(found.nearBy >= from);
      certainlyNear += found.nearBy < 1e30f;
      tightlyNear += found.nearBy < 1e30f && found.nearBy - found.nearLow <= 0.01f * sensor.scale * c.clearance;
    }
    const Mesh &a = impl.meshes[c.query.mesh], &b = impl.meshes[impl.objects[c.object].object.mesh];
    const std::array<Place, 3> frame = frameOf(sensor, c.query.direction);
    const Place anchor =
        placed(c.query.worldFromMesh, {found.anchorA[0] * a.unit + a.origin[0], found.anchorA[1] * a.unit + a.origin[1],
                                       found.anchorA[2] * a.unit + a.origin[2]});
    const Real offA = offBy(found.cornersA, a, c.triangleA, c.query.worldFromMesh, anchor, frame, scale);
    const Real offB =
        offBy(found.cornersB, b, c.triangleB, impl.objects[c.object].object.worldFromMesh, anchor, frame, scale);
    CAPTURE(double(offA), found.errorA, double(offB), found.errorB);
    CHECK(offA <= found.errorA + c.doubt * scale);
    // B's corners are relative to A's anchor, whose error is part of errorA.
    CHECK(offB <= found.errorA + found.errorB + c.doubt * scale);
    closest = std::max({closest, offA / found.errorA, offB / (found.errorA + found.errorB)});
  }
  CHECK(inRange > count / 2);
  CHECK(tight > count / 50);
  CHECK(tightFrom > count / 50);
  CHECK(certainlyNear > inRange / 2);
  CHECK(tightlyNear > certainlyNear / 2);
  CHECK(closest > 0.01);
}

}  // namespace

TEST_CASE("no bound of the search excludes a pair that touches, at any size, distance and position") {
  const uint64_t seed = GENERATE(range(1, 6));
  CAPTURE(seed);
  Margins(seed).check();
}
