// Sensors that turn off what they rest on: boxes against the depth of their interiors, by separating axes.
#include <cmath>

#include "scene/scene.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/seeds.h"
#include "support/world.h"
#include "unit/turn_truth.h"
#include "workloads/generate.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using test::answer;
using test::turned;
using tools::Random;

namespace {

Vector column(const Transform& pose, int k) {
  return {pose.m[k], pose.m[4 + k], pose.m[8 + k]};
}

// A box: its middle, and half its edges.
struct Placed {
  Vector middle, edge[3];

  Placed(const Transform& pose, const Vector& sides) : middle(column(pose, 3)) {
    for (int k = 0; k < 3; ++k) edge[k] = scaled(0.5 * sides[k], column(pose, k));
  }
  Placed turnedBy(const Query& query, double s) const {
    Placed out = *this;
    out.middle = turned(query, middle, s);
    for (int k = 0; k < 3; ++k) out.edge[k] = minus(turned(query, along(middle, 1, edge[k]), s), out.middle);
    return out;
  }
  double reachAlong(const Vector& n) const {
    return std::abs(dot(n, edge[0])) + std::abs(dot(n, edge[1])) + std::abs(dot(n, edge[2]));
  }
};

// How far the interiors overlap along the direction in which they do so least; below 0, how far they are apart at
// least.
double depthOf(const Placed& a, const Placed& b) {
  double depth = INFINITY;
  const auto tryAlong = [&](const Vector& n, double least) {
    const double length = std::sqrt(dot(n, n));
    if (length <= least) return;
    const double apart = std::abs(dot(n, minus(b.middle, a.middle)));
    depth = std::min(depth, (a.reachAlong(n) + b.reachAlong(n) - apart) / length);
  };
  for (int i = 0; i < 3; ++i) {
    tryAlong(a.edge[i], 0);
    tryAlong(b.edge[i], 0);
    for (int k = 0; k < 3; ++k) {
      const double sizes = dot(a.edge[i], a.edge[i]) * dot(b.edge[k], b.edge[k]);
      tryAlong(cross(a.edge[i], b.edge[k]), 1e-6 * std::sqrt(sizes));
    }
  }
  return depth;
}

}  // namespace

TEST_CASE("a box that turns may leave the table that it rests on or slide over it, but not sink into it") {
  Random random(4);
  for (int trial = 0; trial < 40; ++trial) {
    // Any place, size and orientation: then it rests to rounding alone.
    const double size = trial < 10 ? 1 : random.magnitude(-3, 3);
    const Transform world =
        trial < 10 ? Transform{} : tools::makePose(random.rotation(), {1, 1, 1}, random.inCube(10 * size));
    const auto direction = [&](const Vector& v) {
      Vector out{};
      for (int k = 0; k < 3; ++k) out = along(out, v[k], column(world, k));
      return out;
    };
    const auto point = [&](const Vector& p) { return along(column(world, 3), size, direction(p)); };
    const auto at = [&](const Vector& p) {
      Transform pose = world;
      const Vector place = point(p);
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) pose.m[4 * i + k] *= size;
        pose.m[4 * i + 3] = place[i];
      }
      return pose;
    };
    Scene scene;
    const MeshId box = add(scene, tools::makeBox({2, 2, 2})), table = add(scene, tools::makeBox({40, 40, 1}));
    const ObjectId under = scene.addObject({.mesh = table, .worldFromMesh = at({0, 0, -0.5})});
    const auto asked = [&](const Vector& axis, double angle, const Vector& centre, const Vector& motion) {
      Query query{.mesh = box, .worldFromMesh = at({1, 2, 1}), .motion = scaled(size, direction(motion))};
      query.turn = Turn{direction(axis), angle, point(centre)};
      query.ignoreLeaving = true;
      const Result found = answer(scene, query);
      CAPTURE(trial, size, angle, found.lo, found.hi);
      if (found.status == Status::overlap) CHECK(found.object == under);
      return found.status;
    };
    CHECK(asked({0, 0, 1}, 1, {1, 2, 7}, {}) == Status::clear);           // on the spot
    CHECK(asked({0, 0, -2}, 9, {3, 3, 0}, {5, 1, 0}) == Status::clear);   // sliding
    CHECK(asked({0, 0, 1}, 2, {1, 2, 0}, {0, 0, 0.5}) == Status::clear);  // screwed upwards
    CHECK(asked({0, 0, 1}, 2, {1, 2, 0}, {0, 0, -0.5}) == Status::overlap);
    CHECK(asked({0, 1, 0}, -0.5, {0, 2, 0}, {}) == Status::clear);          // lifted about a lower edge
    CHECK(asked({0, 1, 0}, 0.5, {0, 2, 0}, {}) == Status::overlap);         // the other way round
    CHECK(asked({0, 1, 0}, 0.5, {1, 2, 0}, {}) == Status::overlap);         // about its middle
    CHECK(asked({0, 1, 0}, 0.5, {1, 2, 0}, {0, 0, 0.6}) == Status::clear);  // rising faster than an edge sinks
    // It comes down elsewhere after it has left: a turn by 200 degrees about a lower edge.
    CHECK(asked({0, 1, 0}, -3.5, {0, 2, 0}, {}) == Status::hit);
  }
}

TEST_CASE("a box does not sink into one of the same footprint, whose sides no edge of it crosses") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  scene.addObject({.mesh = box});
  Query query{.mesh = box};
  query.ignoreLeaving = true;
  const auto statusOf = [&](double height, double angle, double way) {
    query.worldFromMesh.m[11] = height;
    query.turn = Turn{{0, 0, 1}, angle, {}};
    query.motion = Vector{0, 0, way};
    return answer(scene, query).status;
  };
  CHECK(statusOf(2, 1e-9, -0.5) == Status::overlap);
  CHECK(statusOf(2, 1e-9, 0.5) == Status::clear);
  CHECK(statusOf(2, 1, 0) == Status::clear);
  // Sunk in a little, it may leave only with so much slack.
  CHECK(statusOf(2 - 1e-3, 0.5, 0.25) == Status::overlap);
  query.slack = 2e-3;
  CHECK(statusOf(2 - 1e-3, 0.5, 0.25) == Status::clear);
  CHECK(statusOf(2 - 1e-3, 0.5, -0.25) == Status::overlap);
}

TEST_CASE("random boxes that touch others at the start block each other exactly if their interiors would overlap") {
  const uint32_t seed = GENERATE(from_range(test::seeds({1, 2, 3, 4})));
  Random random(seed);
  int statuses[5] = {}, free = 0, wide = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double size = random.magnitude(-3, 3);
    Scene scene;
    // On a lattice, so that sides, edges and corners touch.
    const auto whole = [&](int from, int to) { return double(from + int(random.below(uint32_t(to - from + 1)))); };
    const auto sides = [&] { return Vector{2 * whole(1, 2), 2 * whole(1, 2), 2 * whole(1, 3)}; };
    const auto at = [&](const Vector& p) {
      Transform pose;
      for (int k = 0; k < 3; ++k) {
        pose.m[5 * k] = size;
        pose.m[4 * k + 3] = size * p[k];
      }
      return pose;
    };
    const Vector sensor = sides();
    std::vector<Placed> others;
    for (int i = 0; i < 3; ++i) {
      const Vector other = sides();
      Vector place;
      // The first one flush along one axis, anywhere along the others.
      const uint32_t side = random.below(3);
      for (uint32_t k = 0; k < 3; ++k) place[k] = whole(-4, 4);
      place[side] = (random.oneIn(2) ? 0.5 : -0.5) * (sensor[side] + other[side]) * (i == 0 ? 1 : 1.25);
      const Transform pose = at(place);
      if (depthOf(Placed(at({}), sensor), Placed(pose, other)) > 0.1 * size) continue;
      scene.addObject({.mesh = add(scene, tools::makeBox(other)), .worldFromMesh = pose});
      others.emplace_back(pose, other);
    }
    Query query{.mesh = add(scene, tools::makeBox(sensor)), .worldFromMesh = at({})};
    query.ignoreLeaving = true;
    Vector axis{}, centre{0.5 * whole(-6, 6), 0.5 * whole(-6, 6), 0.5 * whole(-6, 6)};
    if (random.oneIn(4)) {
      axis = random.direction();
    } else {
      axis[random.below(3)] = random.oneIn(2) ? 1 : -1;
    }
    query.turn = Turn{axis, random.uniform(0.01, 1) * (random.oneIn(8) ? 4 : 1), scaled(size, centre)};
    if (random.oneIn(2)) {
      Vector way{};
      way[random.below(3)] = random.uniform(-2, 2);
      if (random.oneIn(3)) way = random.inCube(2);
      query.motion = scaled(size, way);
    }
    const Result found = answer(scene, query);
    ++statuses[static_cast<size_t>(found.status)];
    const Placed start(at({}), sensor);
    const auto depthAt = [&](double s) {
      const Placed now = start.turnedBy(query, s);
      double depth = -INFINITY;
      for (const Placed& other : others) depth = std::max(depth, depthOf(now, other));
      return depth / size;
    };
    CAPTURE(seed, trial, size, found.lo, found.hi, static_cast<uint32_t>(found.status));
    // A box's longest side is at most 6: the tolerance is at most 6e-6.
    const bool touches = found.status == Status::hit || found.status == Status::overlap;
    const double until = found.status == Status::clear ? 1 : found.lo;
    double most = -INFINITY;
    for (int k = 0; k <= 400; ++k) most = std::max(most, depthAt(until * k / 400));
    CHECK(most < 6e-6);
    if (touches && found.hi > 0) CHECK(depthAt(found.hi) > 0);
    // What blocks at the start has sunk in soon: no part is farther than 20 sizes from the axis.
    if (found.status == Status::overlap) {
      double deepest = -INFINITY;
      for (int k = 1; k <= 20; ++k) deepest = std::max(deepest, depthAt(std::min(1.0, 1e-5 * k)));
      CHECK(deepest > 0);
    }
    wide += found.status == Status::hit && found.hi - found.lo > 1e-4;
    free += found.status == Status::clear && !others.empty();
  }
  CAPTURE(seed, statuses[0], statuses[1], statuses[2], statuses[3], statuses[4]);
  CHECK(statuses[static_cast<size_t>(Status::hit)] > 10);
  CHECK(statuses[static_cast<size_t>(Status::overlap)] > 20);
  CHECK(free > 5);
  // Where an edge slides along another one, or before it goes into something.
  CHECK(statuses[static_cast<size_t>(Status::undecided)] <= 8);
  CHECK(wide <= 8);
}
