// Each library on cases whose answers are known, as the chart uses it.
#include "baselines/baseline.h"
#include "support/catch.h"
#include "workloads/shapes.h"

using namespace radar;
using namespace radar::tools;

namespace {

Transform poseAt(double x, double y, double z) {
  Transform pose;
  pose.m[3] = x;
  pose.m[7] = y;
  pose.m[11] = z;
  return pose;
}

Query sweepOf(uint32_t mesh, const Transform& pose, double distance) {
  Query query;
  query.mesh = mesh;
  query.worldFromMesh = pose;
  query.direction = {0, 0, 2};
  query.distance = distance;
  return query;
}

}  // namespace

TEST_CASE(
    "every library finds two boxes 3 apart, in turned and scaled poses, leaves out what is excluded, and nothing in an "
    "empty scene") {
  Workload workload;
  workload.meshes = {makeBox({1, 1, 1}), makeBox({2, 2, 2})};
  Transform wide = poseAt(0, 0, 5);  // from z = 4 up
  wide.m[0] = 3;
  const std::vector<Instance> objects{{1, wide}, {0, poseAt(40, 0, 5)}};
  Transform turned{{0, -2, 0, 0.1, 2, 0, 0, 0.2, 0, 0, 2, 0}};  // edges of 2: up to z = 1
  REQUIRE(peerRows().size() == 6);
  for (const BaselineRow& row : peerRows()) {
    CAPTURE(row.family);
    const std::unique_ptr<Baseline> baseline = row.make(workload, row.sizes.back());
    baseline->show({});
    CHECK_FALSE(baseline->cast(sweepOf(0, turned, 10)).has_value());
    baseline->show(objects);
    const std::optional<double> t = baseline->cast(sweepOf(0, turned, 10));
    REQUIRE(t.has_value());
    CHECK(*t == Approx(3).margin(1e-5));
    CHECK_FALSE(baseline->cast(sweepOf(0, turned, 2.9)).has_value());
    Query without = sweepOf(0, turned, 10);
    without.exclude = {0};
    CHECK_FALSE(baseline->cast(without).has_value());
    std::vector<Instance> moved = objects;
    moved[0].worldFromMesh.m[11] = 6;
    baseline->show(moved);
    CHECK(baseline->cast(sweepOf(0, turned, 10)).value_or(-1) == Approx(4).margin(1e-5));
    baseline->show(std::vector<Instance>{objects[1]});
    CHECK_FALSE(baseline->cast(sweepOf(0, turned, 10)).has_value());
  }
}

TEST_CASE("a hull closes a cup, triangles do not") {
  Workload workload;
  workload.meshes = {makeCup(2, 3, 0.1, 16), makeBox({1, 1, 1})};
  Transform upsideDown{{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0}};  // opens towards -z, its floor around z = 0
  upsideDown.m[11] = 3;                                          // the rim at z = 0, the floor's inside near 2.9
  const std::vector<Instance> objects{{1, poseAt(0, 0, -2)}};
  Query down = sweepOf(0, upsideDown, 10);
  down.direction = {0, 0, -1};
  for (const BaselineRow& row : peerRows()) {
    CAPTURE(row.family);
    const std::unique_ptr<Baseline> baseline = row.make(workload, row.sizes.back());
    baseline->show(objects);
    const std::optional<double> t = baseline->cast(down);
    REQUIRE(t.has_value());
    CHECK(*t == Approx(row.family == "Bullet hull" ? 1.5 : 4.4).margin(1e-3));
  }
}
