// The input of the search that the device makes of a host's queries, against exact arithmetic.
#include <algorithm>
#include <bit>
#include <cmath>

#include "embed/host_queries.h"
#include "embed/written_queries.h"
#include "exact/contact.h"
#include "math/frame.h"
#include "support/catch.h"
#include "support/encoded.h"
#include "support/exact_placement.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using Real = long double;
using Row = std::array<Real, 3>;

/// What the device makes of written queries in a scene.
struct OnDevicePlan : test::Encoded {
  OnDevicePlan(const Scene& scene, std::span<const HostQuery> queries) : copy(test::device().impl()) {
    const Device::Impl& device = test::device().impl();
    const auto count = static_cast<uint32_t>(queries.size());
    ContactPass search(device, copy, {});
    HostQueriesPass pass(device);
    const test::OnDevice buffer(test::bytesOf(queries));
    search.stageWritten(count, scene.impl());
    pass.stage({.buffer = buffer.get(), .count = count});
    Encoded::operator=(test::encodedBy(
        search, count, [&](const gpu::Commands& commands) { pass.record(commands, search, copy, scene.impl()); }));
    excluded = test::elementsOf(search.stated().excluded, 0, count);
  }
  GpuScene copy;
  std::vector<uint32_t> excluded;
};

Real dot(const Row& p, const Row& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

Row rowOf(const float* values) {
  return {values[0], values[1], values[2]};
}

Row unitOf(const std::array<double, 3>& direction) {
  Row unit{direction[0], direction[1], direction[2]};
  const Real length = std::sqrt(dot(unit, unit));
  for (Real& x : unit) x /= length;
  return unit;
}

/// The frame's rows are orthonormal and turn the direction to z, within little more than the rounding of its floats,
/// for which the margins of the search have room.
void checkFrame(const gpu::Sensor& sensor, const std::array<double, 3>& direction, Real& worst) {
  CHECK(std::max({sensor.clearance, sensor.slackShare, sensor.tolerance}) == 0);
  const Row unit = unitOf(direction);
  const Row rows[3] = {rowOf(sensor.across), rowOf(sensor.upwards), rowOf(sensor.along)};
  for (int row = 0; row < 3; ++row) {
    const Real off = std::abs(dot(rows[row], unit) - (row == 2 ? 1 : 0));
    worst = std::max(worst, off);
    CHECK(off < 1.5 * 0x1p-24L);
    CHECK(sensor.direction[row] == sensor.along[row]);
    for (int other = 0; other < row; ++other) CHECK(std::abs(dot(rows[row], rows[other])) < 0x1p-22L);
    CHECK(std::abs(dot(rows[row], rows[row]) - 1) < 0x1p-22L);
  }
}

/// The sensor's size is scaled to 1 to 2. Its box contains the CPU's in the world, wherever rounding and the change of
/// the direction may put it.
void checkBox(const gpu::Sensor& sensor, const Mesh& mesh, const Query& query, const ObjectTree& tree) {
  const Box box = boxOf(mesh, query.worldFromMesh.m);
  const Row unit = unitOf(query.direction);
  Real farthest = 0;
  for (int k = 0; k < 3; ++k) {
    farthest +=
        std::max(std::abs(tree.worldBox().lo[k] - box.middle(k)), std::abs(tree.worldBox().hi[k] - box.middle(k)));
  }
  const Real size = std::max<Real>(sensor.placement.size, 0x1p-38L * farthest) * sensor.scale;
  CHECK((size > 0.9999L && size < 2.0001L));
  for (int k = 0; k < 3; ++k) {
    const Real room = farthest * (0x1p-39L + std::abs(sensor.direction[k] - unit[k]) - 4e-7L * std::abs(unit[k]));
    const Real centre = Real(tree.anchor()[k]) + sensor.centre[k];
    CHECK(centre + sensor.halfExtent[k] >= box.hi[k] + room);
    CHECK(centre - sensor.halfExtent[k] <= box.lo[k] - room);
  }
}

/// All but the placement, which may differ, has the CPU's numbers.
void checkSweep(const gpu::Sensor& sensor, const gpu::Sweep& sweep, const Query& query, uint32_t number) {
  CHECK(std::equal(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), sweep.pose));
  const Vector direction = scaledDirection(query.direction);
  CHECK(std::equal(direction.begin(), direction.end(), sweep.direction));
  CHECK(sweep.distance == query.distance);
  if (test::device().doubles()) {
    CHECK((sweep.directionLength == exact::length(direction) || sweep.cpuDecides == 1));
  } else {
    CHECK(sweep.directionLength == 0);
  }
  CHECK(sweep.anyHit == (query.anyHit ? 1 : 0));
  CHECK(sweep.result == number);
  CHECK(sweep.ignoreLeaving == 0);
  CHECK(sweep.scale == sensor.scale);
  CHECK(sweep.start == sensor.distance);
  int exponent = 0;
  CHECK(std::frexp(sensor.scale, &exponent) == 0.5f);
  CHECK(sensor.scale * sensor.unscale == 1);
  CHECK(sensor.distance == std::min(query.distance * sensor.scale, 0x1p42));
  CHECK(sensor.stopBefore == (query.anyHit ? sensor.distance : -1));
  CHECK(sensor.mask == query.mask);
  CHECK(sensor.firstExcluded == number);
  CHECK(sensor.endExcluded == number + query.exclude.size());
}

HostQuery randomQuery(const Scene& scene, MeshId mesh, double scale, const std::array<double, 3>& centre,
                      tools::Random& random) {
  Query query;
  query.mesh = mesh;
  const double size = scale * std::exp2(random.uniform(-6, 6)) / scene.impl().meshes[mesh].unit;
  query.worldFromMesh = random.affine({});
  for (size_t i = 0; i < 12; ++i) {
    query.worldFromMesh.m[i] =
        i % 4 == 3 ? centre[i / 4] + 10 * scale * random.uniform(-1, 1) : size * query.worldFromMesh.m[i];
  }
  query.direction = random.oneIn(5) ? random.axis() : random.direction();
  if (random.oneIn(4)) query.direction[random.below(3)] *= std::exp2(random.uniform(-140, 0));
  const double speed = std::exp2(random.oneIn(2) ? 0 : random.uniform(-140, 126));
  for (double& x : query.direction) x *= speed;
  if (query.direction == std::array<double, 3>{}) query.direction = {0, 0, 1};
  query.distance =
      random.oneIn(8) ? 0 : scale * std::exp2(random.oneIn(2) ? random.uniform(-2, 8) : random.uniform(-40, 46));
  query.anyHit = random.oneIn(3);
  query.mask = random.below(100);
  if (random.oneIn(2)) query.exclude = {random.below(9)};
  return test::hostQueryOf(query);
}

}  // namespace

TEST_CASE(
    "a written query becomes the input that the CPU encodes, with room for every rounding, at any scale and place",
    "[subgroups]") {
  // Exponents of the sizes, and in comparison of how far away the scene is and how far it extends.
  struct Exponents {
    int size, away, extent;
  };
  const auto [size, away, extent] = GENERATE(values<Exponents>({{0, 0, 2},
                                                                {0, 12, 2},
                                                                {0, 20, 2},
                                                                {0, 0, 20},
                                                                {0, 4, 36},
                                                                {0, 30, 44},
                                                                {-45, 4, 2},
                                                                {-45, 12, 30},
                                                                {45, 4, 2},
                                                                {45, 20, 30}}));
  CAPTURE(size, away, extent);
  tools::Random random(static_cast<uint64_t>(200 + size + away + extent));
  const double scale = std::exp2(size);
  const std::array<double, 3> centre = random.inCube(scale * std::exp2(away));
  Scene scene;
  std::vector<MeshId> meshes;
  for (uint32_t i = 0; i < 24; ++i) {
    meshes.push_back(test::addMesh(scene, test::oddMesh(random, i % 19, random.uniform(-17, 17))));  // but for points
  }
  for (ObjectId id = 0; id < 9; ++id) {
    const MeshId mesh = meshes[random.below(24)];
    Transform pose = random.affine(centre);
    if (id == 0) pose.m[3] += scale * std::exp2(extent);
    for (size_t i = 0; i < 11; ++i) {
      if (i % 4 != 3) pose.m[i] *= scale / scene.impl().meshes[mesh].unit;
    }
    scene.addObject({mesh, pose, ~0u});
  }
  std::vector<HostQuery> written;
  for (int i = 0; i < 1500; ++i) {
    const HostQuery query = randomQuery(scene, meshes[random.below(24)], scale, centre, random);
    if (validate(test::queryOf(query), scene).empty()) written.push_back(query);
  }
  const OnDevicePlan planned(scene, written);
  const ObjectTree& tree = scene.impl().objectTree();
  // The same queries, as the CPU states them.
  SearchPlan batch;
  for (uint32_t i = 0; i < written.size(); ++i) {
    REQUIRE(batch.add(test::queryOf(written[i]), i, scene.impl(), tree) == Planned::added);
  }
  GpuScene copy(test::device().impl());
  const test::Encoded ofCpu = test::encodedBy(copy, scene.impl(), batch);
  test::BoundsUsed used;
  Real worst = 0;
  uint32_t tasks = 0;
  for (uint32_t i = 0; i < written.size(); ++i) {
    CAPTURE(i);
    const Query query = test::queryOf(written[i]);
    CHECK(planned.states[i].flags == ofCpu.states[i].flags);
    if (planned.states[i].flags != 0) {
      CHECK(planned.states[i].flags == gpu::kSearchOutOfRange);
      continue;
    }
    ++tasks;
    const gpu::Sensor& sensor = planned.sensors[i];
    const Mesh& mesh = scene.impl().meshes[query.mesh];
    test::checkPlacement(mesh, query.worldFromMesh, sensor.placement, used);
    CHECK(sensor.placement.mesh == query.mesh);
    CHECK(sensor.placement.root == planned.copy.record(query.mesh).firstNode);
    checkFrame(sensor, query.direction, worst);
    checkBox(sensor, mesh, query, tree);
    checkSweep(sensor, planned.sweeps[i], query, i);
    if (!query.exclude.empty()) CHECK(planned.excluded[i] == query.exclude[0]);
    CHECK(std::bit_cast<float>(planned.states[i].hi) == sensor.distance);
    CHECK(planned.states[i].least == gpu::kNobody);
  }
  CHECK(tasks > 700);
  CHECK(worst > 0x1p-26L);
  CHECK(used.inverse > 0.0001);
  REQUIRE(planned.tasks.size() == tasks);
  std::vector<uint32_t> seen(written.size());
  for (const gpu::SearchTask& task : planned.tasks) {
    CHECK(++seen.at(task.search) == 1);
    CHECK(task.object == gpu::kNobody);
    CHECK(task.b == tree.nodes()[0].link);
    CHECK(task.gap == 0);
  }
  CHECK(planned.counts.queries == written.size());
}

TEST_CASE("a small sensor in the middle of a scene far from the origin has a box that contains it") {
  Scene scene;
  const MeshId mesh = test::addBox(scene);
  const auto at = [&](double scale) {
    return Transform{{scale, 0, 0, 0x1p40, 0, scale, 0, 0x1p40, 0, 0, scale, 0x1p40}};
  };
  scene.addObject({mesh, at(1), ~0u});
  const Query query{.mesh = mesh, .worldFromMesh = at(0x1p-14), .direction = {1, 2, 3}, .distance = 1};
  const HostQuery written = test::hostQueryOf(query);
  const OnDevicePlan planned(scene, {&written, 1});
  REQUIRE(planned.states[0].flags == 0);
  for (int k = 0; k < 3; ++k) REQUIRE(scene.impl().objectTree().anchor()[k] == 0x1p40);
  checkBox(planned.sensors[0], scene.impl().meshes[mesh], query, scene.impl().objectTree());
}
