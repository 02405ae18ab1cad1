// Each library on cases whose answers are known, as the chart uses it.
#include <cmath>

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
  REQUIRE(peerRows().size() == 7);
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
    CHECK(*t == Approx(row.family.starts_with("Bullet hull") ? 1.5 : 4.4).margin(1e-3));
  }
}

TEST_CASE("FCL finds how far a body is, and when it meets something on a way that turns") {
  Workload workload;
  workload.meshes = {makeBox({10, 1, 1}), makeBox({1, 1, 3})};
  workload.scenes.emplace_back().instances = {{1, poseAt(-1, 6, 0)}};
  const std::unique_ptr<RigidBodies> bodies = makeRigidBodies(workload);
  REQUIRE(bodies != nullptr);
  CHECK(bodies->distance({1, poseAt(4, 6, 0)}) == Approx(4));
  CHECK(bodies->continuous({1, poseAt(9, 6, 0)}, poseAt(-11, 6, 0), 100).value_or(-1) == Approx(0.45).margin(0.011));
  CHECK_FALSE(bodies->continuous({1, poseAt(9, 8, 0)}, poseAt(-11, 8, 0), 100).has_value());
  // A rod about its middle, whose upper side passes the post's nearest edge.
  const auto at = [](double s) {
    const double angle = 2 * s, c = std::cos(angle), sine = std::sin(angle);
    return std::vector{Instance{0, {{c, -sine, 0, 0, sine, c, 0, 2, 0, 0, 1, 0}}}};
  };
  const double expected = (std::atan2(3.5, -0.5) - std::asin(0.5 / std::hypot(0.5, 3.5))) / 2;
  CHECK(bodies->stepped(64, at).value_or(-1) == Approx(expected).margin(1e-6));
  CHECK(bodies->continuous(at(0)[0], at(1)[0].worldFromMesh, 200).value_or(-1) == Approx(expected).margin(0.006));
  CHECK_FALSE(bodies->stepped(64, [&](double s) { return at(0.9 * expected * s); }).has_value());
}
