// First contact of sensors that turn: closed forms, and random scenes against exact tests of poses before and at
// contact, which long doubles place.
#include <cmath>

#include "scene/scene.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/seeds.h"
#include "support/world.h"
#include "unit/turn_truth.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using test::answer;
using test::turned;
using test::TurnTruth;
using tools::placedAt;
using tools::Random;

namespace {

constexpr double kPi = 3.14159265358979323846;

double longestSide(const Scene& scene, const Query& query) {
  const Box box = boxOf(scene.impl().meshes[query.mesh], query.worldFromMesh.m);
  return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

// Of the sensor's vertices past an object, at nine times.
double greatestSpeed(const Scene& scene, const Query& query, ObjectId object) {
  const Mesh& mesh = scene.impl().meshes[query.mesh];
  const Turn& turn = *query.turn;
  const Vector way = query.motion.value_or(Vector{}), past = minus(way, scene.impl().objects[object].object.motion);
  const Vector spin = scaled(turn.angle / std::sqrt(dot(turn.axis, turn.axis)), turn.axis);
  double most = 0;
  for (uint32_t i = 0; i < mesh.triangleCount(); ++i) {
    for (const Vector& corner : placedTriangle(mesh, query.worldFromMesh, i)) {
      for (double s = 0; s <= 1; s += 0.125) {
        const Vector arm = minus(turned(query, corner, s), along(turn.centre, s, way));
        const Vector speed = along(past, 1, cross(spin, arm));
        most = std::max(most, std::sqrt(dot(speed, speed)));
      }
    }
  }
  return most;
}

}  // namespace

TEST_CASE("a rod that sweeps a post touches it at the angle that geometry says, whatever the scale and the place") {
  for (const double size : {1e-5, 1.0, 1e6}) {
    for (const Vector& place : {Vector{}, Vector{1e3, -2e3, 5e2}}) {
      Scene scene;
      const float s = static_cast<float>(size);
      const MeshId rod = add(scene, tools::makeBox({10 * s, s, s})), post = add(scene, tools::makeBox({s, s, 3 * s}));
      const Vector centre = scaled(size, place);
      // The rod lies along x from its end, the centre; the post's nearest edge is at (-0.5, 6.5).
      scene.addObject({.mesh = post, .worldFromMesh = placedAt(along(centre, size, {-1, 6, 0}))});
      Query query{.mesh = rod, .worldFromMesh = placedAt(along(centre, size, {5, 0, 0}))};
      query.turn = Turn{{0, 0, 7}, kPi, centre};
      const Result found = answer(scene, query);
      // The rod's upper side is half a size from the axis: its line passes through (-0.5, 5.5) first.
      const double corner = std::atan2(5.5, -0.5), below = std::asin(0.5 / std::hypot(5.5, 0.5));
      const double expected = (corner - below) / kPi;
      CAPTURE(size, place[0], found.lo, found.hi, expected);
      REQUIRE(found.status == Status::hit);
      CHECK(found.lo <= expected + 1e-12);
      CHECK(found.hi >= expected - 1e-12);
      CHECK((found.hi - found.lo) * kPi * 10.1 * size <= 1e-6 * longestSide(scene, query) + 1e-12 * size);
      CHECK(found.fraction == found.lo);
      CHECK(found.gap == 0);
      query.turn->angle = -kPi;  // the other way round it comes later, after three quarters
      CHECK(answer(scene, query).status == Status::clear);
    }
  }
}

TEST_CASE("what only the middle of an arc reaches is found") {
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene;
    const MeshId rod = add(scene, tools::makeBox({2, 1e-3f, 1e-3f})),
                 post = add(scene, tools::makeBox({0.1f, 1e-3f, 1e-3f}));
    // The tip, 1 from the axis, is at cos(angle / 2) along x at both ends of the turn, and at 1 amid it.
    const double angle = random.uniform(0.02, 0.5), bulge = angle * angle / 8;
    const Vector place = scaled(random.magnitude(-2, 3), random.direction());
    scene.addObject(
        {.mesh = post, .worldFromMesh = placedAt(along(place, 1, {1.05 - random.uniform(0.2, 0.8) * bulge, 0, 0}))});
    Query query{.mesh = rod, .worldFromMesh = placedAt(place)};
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    query.worldFromMesh.m[0] = query.worldFromMesh.m[5] = c;
    query.worldFromMesh.m[1] = s;
    query.worldFromMesh.m[4] = -s;
    query.turn = Turn{{0, 0, 1}, angle, place};
    CAPTURE(trial, angle, place[0]);
    CHECK(answer(scene, query).status == Status::hit);
  }
}

TEST_CASE("a box that turns about one of its edges lands on a plane after the angle between them") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2})), plate = add(scene, tools::makeBox({40, 40, 1}));
  scene.addObject({.mesh = plate, .worldFromMesh = placedAt({0, 0, -0.5})});
  for (const double tilt : {1e-4, 0.1, 0.7}) {
    // The edge along y at x = -1 is the axis, a little above the plane; the rest is tilted upwards.
    const double gap = 1e-3, c = std::cos(tilt), s = std::sin(tilt);
    Query query{.mesh = box};
    query.worldFromMesh.m = {c, 0, -s, -1 + c + s * -1, 0, 1, 0, 0, s, 0, c, gap + s + c};
    query.turn = Turn{{0, 1, 0}, 1, {-1, 0, gap}};
    const Result found = answer(scene, query);
    // The lower edge at the other end, 2 from the axis, comes down to the plane.
    const double expected = tilt + std::asin(gap / 2);
    CAPTURE(tilt, found.lo, found.hi, expected);
    REQUIRE(found.status == Status::hit);
    CHECK(found.lo <= expected + 1e-7);
    CHECK(found.hi >= expected - 1e-7);
    CHECK(found.hi - found.lo < 1e-5);
  }
}

TEST_CASE("what turns on a plane that it does not touch is free, however near it is, and what touches it overlaps") {
  for (const double gap : {0.0, 1e-10, 1e-6}) {
    Scene scene;
    const MeshId box = add(scene, tools::makeBox({2, 3, 2})), plate = add(scene, tools::makeBox({40, 40, 2}));
    scene.addObject({.mesh = plate, .worldFromMesh = placedAt({0, 0, -1})});
    Query query{.mesh = box, .worldFromMesh = placedAt({1, 2, 1 + gap})};
    query.turn = Turn{{0, 0, 1}, 20, {3, 0, 0}};
    query.motion = {0.5, 0.25, 0};
    const Result found = answer(scene, query);
    CAPTURE(gap);
    CHECK(found.status == (gap == 0 ? Status::overlap : Status::clear));
    // It drops below the plane.
    query.motion = {0, 0, -1};
    const Result landed = answer(scene, query);
    CHECK(landed.status == (gap == 0 ? Status::overlap : Status::hit));
    if (gap > 0) CHECK(landed.lo <= 1.01 * gap);
    if (gap > 0) CHECK(landed.hi >= 0.99 * gap);
  }
}

TEST_CASE("ten thousand turns, and a centre a billion sizes away, are answered as few and near ones are") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({.mesh = box, .worldFromMesh = placedAt({0, 0, 3})});
  // It screws itself upwards: whatever its angle, its upper side arrives when it has risen by 2.
  Query query{.mesh = box};
  query.motion = {0, 0, 4};
  query.turn = Turn{{0, 0, 1}, 0x1p16, {0.25, 0, 0}};
  const Result screwed = answer(scene, query);
  CAPTURE(screwed.lo, screwed.hi);
  CHECK(screwed.status == Status::hit);
  CHECK(screwed.lo <= 0.5);
  CHECK(screwed.hi >= 0.5);
  CHECK(screwed.hi - screwed.lo < 1e-6);
  // About an axis so far away it moves all but straight, by 3.
  query.motion.reset();
  query.turn = Turn{{0, 1, 0}, 3e-9, {1e9, 0, 0}};
  const Result swung = answer(scene, query);
  CAPTURE(swung.lo, swung.hi);
  CHECK(swung.status == Status::hit);
  CHECK(swung.lo <= 2 / 3.0 + 1e-7);
  CHECK(swung.hi >= 2 / 3.0 - 1e-7);
  CHECK(swung.hi - swung.lo < 1e-6);
}

TEST_CASE("a turn by no angle is the step alone, with its bits") {
  Random random(1);
  Scene scene;
  const MeshId torus = add(scene, tools::makeTorus(1, 0.3, 12, 6));
  for (int i = 0; i < 20; ++i) scene.addObject({.mesh = torus, .worldFromMesh = random.affine(random.inCube(4))});
  std::vector<Query> steps, turns;
  for (int i = 0; i < 100; ++i) {
    Query query{.mesh = torus, .worldFromMesh = random.affine(random.inCube(4)), .motion = random.inCube(3)};
    if (random.oneIn(3)) query.clearance = 0.1;
    steps.push_back(query);
    query.turn = Turn{random.oneIn(2) ? Vector{} : Vector(random.direction()), 0, random.inCube(5)};
    turns.push_back(query);
  }
  CpuSweeper sweeper(scene);
  CHECK(test::differenceOf(sweeper.run(turns).results, sweeper.run(steps).results) == "");
}

TEST_CASE("random sensors that turn meet nothing before lo, and certainly something at hi") {
  const uint32_t seed = GENERATE(from_range(test::seeds({1, 2, 3})));
  Random random(seed);
  int statuses[5] = {}, wide = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double size = random.magnitude(-4, 4);
    // What is thinner than the tolerance gets no deeper into what it passes through: that may be left undecided.
    const tools::Soup soup = tools::kSoups[random.below(3)];
    const bool getsDeep = soup == tools::Soup::plain;
    Scene scene;
    const MeshId meshes[] = {add(scene, tools::makeBox({1, 0.3, 2})), add(scene, tools::makeTorus(1, 0.3, 8, 5)),
                             add(scene, tools::makePlate(2, 1, 1e-4)), add(scene, tools::makeRod(0.01, 3, 5)),
                             add(scene, tools::makeSoup(soup, 6, random))};
    const auto pose = [&](double within) {
      Transform out = random.affine(random.inCube(within));
      for (double& entry : out.m) entry *= size;
      return out;
    };
    const bool move = random.oneIn(4);
    for (int i = 0; i < 6; ++i) {
      const Vector way = move && random.oneIn(2) ? Vector(random.inCube(size)) : Vector{};
      scene.addObject({.mesh = meshes[random.below(5)], .worldFromMesh = pose(3), .motion = way});
    }
    Query query{.mesh = meshes[random.below(5)], .worldFromMesh = pose(3)};
    const double arm = random.oneIn(3) ? random.magnitude(0, 4) : 3;
    query.turn = Turn{random.inCube(random.magnitude(-3, 3)),
                      random.uniform(-2, 2) * random.magnitude(-3, 1) * (3 / arm), random.inCube(arm * size)};
    if (!random.oneIn(3)) query.motion = random.inCube(3 * size);
    if (random.oneIn(3)) query.clearance = random.uniform(0, 1) * size;
    const Result found = answer(scene, query);
    if (getsDeep || found.status != Status::undecided) ++statuses[static_cast<size_t>(found.status)];
    const TurnTruth truth(query, scene);
    // Of what doubles keep of places so far from the origin.
    const double rounding = 1e-10 * size + 1e-14 * arm * size;
    CAPTURE(seed, trial, size, arm, found.lo, found.hi, query.turn->angle, query.clearance,
            static_cast<uint32_t>(found.status));
    const bool touches = found.status == Status::hit || found.status == Status::overlap;
    const double free = found.status == Status::clear ? 1 : found.lo;
    for (int k = 0; k <= 60 && free > 0; ++k) REQUIRE(!truth.meet((1 - 1e-12) * free * k / 60, rounding));
    if (touches && found.hi > 0) REQUIRE(truth.meet(found.hi, query.clearance > 0 ? -rounding : 0));
    if (found.status == Status::overlap) {
      Query still = query;
      still.turn.reset();
      still.motion = Vector{};
      const Result expected = answer(scene, still);
      REQUIRE(expected.status == Status::overlap);
      CHECK((found.object == expected.object && found.triB == expected.triB && found.triA == expected.triA));
    }
    if (found.status == Status::hit && getsDeep) {
      const double tolerance = 1e-6 * std::max(longestSide(scene, query), query.clearance);
      wide += (found.hi - found.lo) * greatestSpeed(scene, query, found.object) > tolerance + rounding;
    }
  }
  CAPTURE(seed, statuses[0], statuses[1], statuses[2], statuses[3], statuses[4]);
  CHECK(statuses[static_cast<size_t>(Status::hit)] > 10);
  CHECK(statuses[static_cast<size_t>(Status::clear)] > 5);
  CHECK(statuses[static_cast<size_t>(Status::undecided)] == 0);
  CHECK(wide <= 2);  // what touches gently gets deeper only later
}

TEST_CASE("of a turn that is cut into parts, the part that meets first does so at the same time") {
  Random random(5);
  Scene scene;
  const MeshId torus = add(scene, tools::makeTorus(1, 0.3, 12, 6));
  for (int i = 0; i < 12; ++i) scene.addObject({.mesh = torus, .worldFromMesh = random.affine(random.inCube(5))});
  int met = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Query query{.mesh = torus, .worldFromMesh = tools::makePose(random.rotation(), {1, 1, 1}, random.inCube(5))};
    query.turn = Turn{random.direction(), random.uniform(0.5, 6), random.inCube(3)};
    query.motion = random.inCube(4);
    const Result whole = answer(scene, query);
    const int parts = 5;
    for (int part = 0; part < parts; ++part) {
      const double from = double(part) / parts;
      Query piece = query;
      for (int k = 0; k < 4; ++k) {
        const auto column = [&](int j) {
          return Vector{query.worldFromMesh.m[j], query.worldFromMesh.m[4 + j], query.worldFromMesh.m[8 + j]};
        };
        const Vector origin = turned(query, column(3), from);
        const Vector placed = k == 3 ? origin : minus(turned(query, along(column(3), 1, column(k)), from), origin);
        for (int i = 0; i < 3; ++i) piece.worldFromMesh.m[4 * i + k] = placed[i];
      }
      for (int i = 0; i < 3; ++i) piece.turn->centre[i] += from * (*query.motion)[i];
      piece.turn->angle /= parts;
      for (double& way : *piece.motion) way /= parts;
      const Result found = answer(scene, piece);
      if (found.status == Status::clear) continue;
      if (found.status == Status::overlap && part > 0) break;  // the seam is within the bracket
      CAPTURE(trial, part, whole.lo, whole.hi, found.lo, found.hi);
      REQUIRE(whole.status == found.status);
      CHECK(from + found.lo / parts <= whole.hi + 1e-12);
      CHECK(from + found.hi / parts >= whole.lo - 1e-12);
      CHECK(found.object == whole.object);
      ++met;
      break;
    }
  }
  CHECK(met > 20);
}

TEST_CASE("hits of a turn are each object's first contact, and options choose among objects as for steps") {
  Random random(6);
  Scene scene;
  const MeshId torus = add(scene, tools::makeTorus(1, 0.3, 10, 5));
  for (int i = 0; i < 10; ++i)
    scene.addObject({.mesh = torus, .worldFromMesh = random.affine(random.inCube(3)), .mask = 1u << (i % 3)});
  CpuSweeper sweeper(scene, 1);
  size_t listed = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Query query{.mesh = torus, .worldFromMesh = tools::makePose(random.rotation(), {1, 1, 1}, random.inCube(5))};
    query.turn = Turn{random.direction(), random.uniform(0.5, 4), random.inCube(3)};
    query.motion = random.inCube(3);
    query.skipOverlapping = random.oneIn(2);
    query.mask = 3;
    query.exclude = {random.below(10)};
    Query all = query;
    all.hits = kAllHits;
    const Answers answers = sweeper.run({&all, 1});
    const std::vector<Result>& hits = answers.lists[0].hits;
    listed += hits.size();
    const Result first = sweeper.run({&query, 1}).results[0];
    CAPTURE(trial, first.lo, first.hi);
    CHECK(first.status == answers.results[0].status);
    CHECK(hits.empty() == (first.status == Status::clear));
    if (!hits.empty()) CHECK(first.object == hits[0].object);
    for (ObjectId id = 0; id < 10; ++id) {
      Query one = query;
      one.exclude.clear();
      for (ObjectId other = 0; other < 10; ++other) {
        if (other != id) one.exclude.push_back(other);
      }
      const Result expected = sweeper.run({&one, 1}).results[0];
      const auto found = std::ranges::find(hits, id, &Result::object);
      const bool takesPart = id != query.exclude[0] && (scene.object(id).mask & 3) != 0;
      CAPTURE(id, expected.lo, expected.hi);
      CHECK((found != hits.end()) == (takesPart && expected.status != Status::clear));
      if (found != hits.end()) {
        CHECK(found->lo <= expected.hi);
        CHECK(found->hi >= expected.lo);
      }
    }
    Query any = query;
    any.anyHit = true;
    const Result decided = sweeper.run({&any, 1}).results[0];
    CHECK((decided.status == Status::hit) == (first.status != Status::clear));
  }
  CHECK(listed > 15);
}

TEST_CASE("a turn that says nothing, or goes with what does not, is refused by name") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  const Query good{.mesh = box, .turn = Turn{{0, 0, 1}, 1, {}}};
  CHECK(validate(good, scene) == "");
  const auto wrong = [&](const auto& change) {
    Query query = good;
    change(query);
    return validate(query, scene);
  };
  CHECK(wrong([](Query& q) { q.turn->axis = {}; }) == "turn: expected an axis that is not zero");
  CHECK(wrong([](Query& q) { q.turn->axis[1] = NAN; }) == "turn: expected an axis of 3 finite numbers, got nan");
  CHECK(wrong([](Query& q) { q.turn->angle = 1e6; }) == "turn: expected a finite angle of at most 2^16, got 1e+06");
  CHECK(wrong([](Query& q) { q.turn->centre[2] = INFINITY; }) == "turn: expected a centre up to 2^800, got inf");
  CHECK(wrong([](Query& q) {
          q.ignoreLeaving = true;
          q.clearance = 1;
        }) == "turn: expected no ignoreLeaving beside it and a clearance");
  CHECK(wrong([](Query& q) { q.distance = 1; }) == "turn: expected no direction and no distance beside it");
  CHECK(wrong([](Query& q) { q.motion = {0, NAN, 0}; }).starts_with("turn: expected a motion up to 2^800"));
  CHECK(validate(good, scene, Mode::sampled).starts_with("mode: expected contact"));
}
