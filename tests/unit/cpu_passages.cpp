// How near a sensor comes on its way, and when its last contact ends: the CPU's answers against brute force over all
// pairs of triangles, distances in long doubles, contacts in exact integers.
#include <algorithm>
#include <cmath>
#include <optional>

#include "brute_force.h"
#include "distances.h"
#include "exact/contact.h"
#include "radar/cpu_sweeper.h"
#include "radar/displacement.h"
#include "radar/shapes.h"
#include "scene_kinds.h"
#include "support/catch.h"
#include "support/seeds.h"
#include "workloads/shapes.h"

using namespace radar;
using soups::Random;
using test::add;
using test::at;
using tools::Vec3;

namespace {

using Real = long double;
// Where rounding of the former seems to find a bracket wrong.
using Fine = boost::multiprecision::cpp_bin_float_quad;

/// A pair of triangles on a query's way, relative to a corner of the sensor's.
template <class Number>
struct Passing {
  distances::Points<Number> a, b;
  distances::Point<Number> unit;
  Number end, size;
};

template <class Number>
Passing<Number> passingOf(const oracle::Corners& a, const oracle::Corners& b, const Vec3& direction, Number end) {
  using std::abs;
  Passing<Number> out{{}, {}, distances::pointOf<Number>(direction), end, 0};
  if (direction != Vec3{}) out.unit /= out.unit.stableNorm();
  for (size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      out.a[i][k] = Number(a[i][size_t(k)]) - a[0][size_t(k)];
      out.b[i][k] = Number(b[i][size_t(k)]) - a[0][size_t(k)];
      out.size = std::max({out.size, Number(abs(out.a[i][k])), Number(abs(out.b[i][k]))});
    }
  }
  for (auto* t : {&out.a, &out.b}) {
    for (auto& p : *t) p /= out.size;
  }
  // Past this, they move apart.
  out.end = std::min(Number(16), Number(end / out.size));
  return out;
}

template <class Number>
Number leastOf(const Passing<Number>& pair) {
  return pair.size * distances::leastDistance(pair.a, pair.b, pair.unit, pair.end, 110);
}

/// Below every distance on the way.
Real roughly(const Passing<Real>& pair) {
  const auto middle = [](const distances::Points<Real>& t) { return distances::Point<Real>((t[0] + t[1] + t[2]) / 3); };
  const auto reach = [&](const distances::Points<Real>& t) {
    return std::max({(t[0] - middle(t)).norm(), (t[1] - middle(t)).norm(), (t[2] - middle(t)).norm()});
  };
  const distances::Point<Real> from = middle(pair.a), to = from + pair.end * pair.unit;
  return pair.size * (distances::fromSegment<Real>(middle(pair.b), from, to) - reach(pair.a) - reach(pair.b));
}

/// The last t at which they are within c; -1 if they never are.
Real lastWithin(const Passing<Real>& pair, Real c) {
  const auto isWithin = [&](Real t) { return distances::distanceAt(pair.a, pair.b, pair.unit, t) <= c / pair.size; };
  Real in = distances::nearestTime(pair.a, pair.b, pair.unit, pair.end, 110), out = pair.end;
  if (!isWithin(in)) return -1;
  if (isWithin(out)) return pair.size * out;
  for (int i = 0; i < 80; ++i) (isWithin((in + out) / 2) ? in : out) = (in + out) / 2;
  return pair.size * in;
}

/// Calls `visit` with the name, the corners and the direction of each pair that takes part.
template <class Visit>
void forEachPair(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Visit& visit) {
  const MeshView sensor = scene.mesh(query.mesh);
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!oracle::takesPart(scene, query, id)) continue;
    if (std::ranges::find(skipped, id) != skipped.end()) continue;
    const Object& object = scene.object(id);
    const MeshView mesh = scene.mesh(object.mesh);
    const Vec3 direction = oracle::directionPast(scene, query, id);
    for (uint32_t triB = 0; triB < mesh.indices.size() / 3; ++triB) {
      for (uint32_t triA = 0; triA < sensor.indices.size() / 3; ++triA) {
        visit(exact::PairName{id, triB, triA}, oracle::corners(sensor, query.worldFromMesh, triA),
              oracle::corners(mesh, object.worldFromMesh, triB), direction);
      }
    }
  }
}

struct Counts {
  int apart = 0, meeting = 0, out = 0, never = 0, stuck = 0, outOfClearance = 0;
};

/// World units of the sensor's way past an object.
template <class Number = Real>
Number wayPast(const Scene& scene, const Query& query, const Vec3& direction) {
  return oracle::isStep(scene, query) ? distances::pointOf<Number>(direction).stableNorm() : Number(query.distance);
}

void checkExit(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Result& exit,
               Counts& counts) {
  const bool isStep = oracle::isStep(scene, query);
  const double end = query.motion ? 1 : query.distance;
  std::optional<oracle::Contact> last;
  bool isStuck = false;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, Vec3 direction) {
    const bool stands = direction == Vec3{};
    if (stands) direction = {1, 0, 0};
    const auto touching = oracle::contact(a, b, direction);
    if (!touching || touching->last.sign() < 0) return;
    const auto contactAt = [&](oracle::Fraction s) {
      if (s.sign() < 0) s = {0};
      return oracle::Contact{s, name.object, name.triB, name.triA, isStep};
    };
    if (stands ? touching->first.sign() > 0 : oracle::compareToTime(contactAt(touching->first), query, end) > 0) return;
    const oracle::Contact own = contactAt(stands ? oracle::Fraction{0} : touching->last);
    isStuck = isStuck || stands || oracle::compareToTime(own, query, end) >= 0;
    const int order = last ? oracle::compare(own.s, last->s) : 1;
    const bool isLess = last && name < exact::PairName{last->object, last->triB, last->triA};
    if (order > 0 || (order == 0 && isLess)) last = own;
  });
  if (!last) {
    REQUIRE(exit.status == Status::clear);
    ++counts.never;
    return;
  }
  REQUIRE(exit.status == Status::hit);
  REQUIRE(exit.t == exit.hi);
  if (isStuck) {
    REQUIRE(exit.lo == end);
    REQUIRE(exit.hi == end);
    ++counts.stuck;
    return;
  }
  CAPTURE(exit.lo, exit.hi, exit.object, exit.triA, exit.triB, last->object, last->triA, last->triB);
  REQUIRE(oracle::compareToTime(*last, query, exit.lo) >= 0);
  REQUIRE(oracle::compareToTime(*last, query, exit.hi) <= 0);
  REQUIRE(exit.hi - exit.lo <= 1e-14 * exit.hi + 1e-300);
  REQUIRE(exit.object == last->object);
  REQUIRE(exit.triB == last->triB);
  REQUIRE(exit.triA == last->triA);
  ++counts.out;
}

void checkClosest(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Closest& found,
                  bool meets, Counts& counts) {
  if (meets) {
    REQUIRE(found.lo == 0);
    REQUIRE(found.hi == 0);
    ++counts.meeting;
    return;
  }
  Real least = INFINITY, size = 0, atNamed = INFINITY;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, const Vec3& d) {
    const Real whole = wayPast(scene, query, d);
    const Passing<Real> pair = passingOf(a, b, d, whole);
    const bool isNamed = name == exact::PairName{found.at.object, found.at.triB, found.at.triA};
    if (!isNamed && roughly(pair) > std::min<Real>(least, found.hi)) return;
    Real own = leastOf(pair);
    if (own < found.lo || isNamed) own = Real(leastOf(passingOf<Fine>(a, b, d, wayPast<Fine>(scene, query, d))));
    if (own < least) size = pair.size;
    least = std::min(least, own);
    if (!isNamed) return;
    const Real way = query.motion ? found.at.t * whole : Real(found.at.t);
    size = std::max(size, pair.size);
    atNamed = pair.size * distances::distanceAt(pair.a, pair.b, pair.unit, std::min<Real>(way / pair.size, pair.end));
  });
  CAPTURE(found.lo, found.hi, double(least), double(size), found.at.fraction);
  if (std::isinf(least)) {
    REQUIRE(std::isinf(found.lo));
    REQUIRE(found.at.object == kNone);
    return;
  }
  // That far the judge narrows times down.
  const Real room = 1e-21L * size;
  REQUIRE(found.lo <= least + room);
  REQUIRE(found.hi >= least - room);
  REQUIRE(found.hi - found.lo <= std::max(1e-13L * size, 1e-8L * least));
  REQUIRE(std::abs(atNamed - found.at.gap) <= 1e-12L * size);
  REQUIRE(atNamed <= found.hi + 1e-12L * size);
  ++counts.apart;
}

void checkExitWithin(const Scene& scene, const Query& query, const Result& exit, Counts& counts) {
  const Real end = query.motion ? 1 : query.distance;
  Real last = -1, room = 0;
  bool isOpen = false;
  forEachPair(scene, query, {}, [&](const exact::PairName&, const auto& a, const auto& b, const Vec3& d) {
    const Real whole = wayPast(scene, query, d), rate = whole > 0 ? end / whole : 0;
    const Passing<Real> pair = passingOf(a, b, d, whole);
    if (roughly(pair) > query.clearance) return;
    const Real slack = 1e-12L * (pair.size + Real(query.clearance));
    if (std::abs(leastOf(pair) - query.clearance) <= slack) isOpen = true;
    const Real own = lastWithin(pair, query.clearance);
    if (own < 0) return;
    // Beyond the pair's reach, or at the end.
    const Real t = pair.end * pair.size >= whole && own >= whole ? end : own * rate;
    if (t >= last) room = slack * rate;
    last = std::max(last, t);
  });
  CAPTURE(exit.lo, exit.hi, double(last), double(room), query.clearance);
  if (isOpen) return;
  if (last < 0) {
    REQUIRE(exit.status == Status::clear);
    return;
  }
  REQUIRE(exit.status == Status::hit);
  // Where it recedes slowly, rounding of the distance matters more.
  const Real loose = std::max(room, 1e-9L * last);
  REQUIRE(exit.lo <= last + room);
  REQUIRE(exit.hi >= last - room);
  REQUIRE(exit.lo >= last - 1e4L * loose);
  REQUIRE(exit.hi <= last + 1e4L * loose);
  ++counts.outOfClearance;
}

void check(const Scene& scene, Query query, Counts& counts) {
  query.ignoreLeaving = query.anyHit = false;
  query.clearance = 0;
  query.hits = 1;
  query.closest = query.exit = true;
  const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
  const Listed& listed = answers.lists.at(0);
  checkExit(scene, query, listed.overlapping, *listed.exit, counts);
  const bool meets = answers.results[0].status != Status::clear;
  checkClosest(scene, query, listed.overlapping, *listed.closest, meets, counts);
  // Within a clearance that something keeps, by far, on a part of the way.
  if (meets || !(listed.closest->hi < 0x1p500 && listed.closest->hi > 0x1p-500)) return;
  query.clearance = 1.5 * listed.closest->hi;
  query.skipOverlapping = query.closest = false;
  query.slack.reset();
  checkExitWithin(scene, query, *CpuSweeper(scene, 1).run({&query, 1}).lists.at(0).exit, counts);
}

/// A cube with this half side.
tools::MeshData cube(double half) {
  return tools::makeBox({2 * half, 2 * half, 2 * half});
}

}  // namespace

TEST_CASE("scenes of all kinds have the closest approach and the last contact that brute force finds") {
  Counts counts;
  for (const kinds::Kind& kind : kinds::all()) {
    for (const uint32_t seed : test::seeds({1, 2})) {
      Random random(seed);
      test::Case of;
      kind.make(random, of);
      for (size_t q = 0; q < of.queries.size(); ++q) {
        INFO(kind.name << ", seed " << seed << ", query " << q);
        check(of.scene, of.queries[q], counts);
      }
    }
  }
  CAPTURE(counts.apart, counts.meeting, counts.out, counts.never, counts.stuck, counts.outOfClearance);
  CHECK(counts.apart > 150);
  CHECK(counts.meeting > 250);
  CHECK(counts.out > 180);
  CHECK(counts.never > 150);
  CHECK(counts.stuck > 40);
  CHECK(counts.outOfClearance > 60);
}

TEST_CASE("a cube that passes another one at an edge is nearest where the middles are level") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  scene.addObject({mesh, at(0, 0, 0)});
  Query query{.mesh = mesh, .worldFromMesh = at(-10, 5, 6), .direction = {1, 0, 0}, .distance = 40, .closest = true};
  const auto ask = [&] { return *CpuSweeper(scene, 1).run({&query, 1}).lists[0].closest; };
  Closest closest = ask();
  CHECK(closest.lo <= 5);
  CHECK(closest.hi >= 5);
  CHECK(closest.hi - closest.lo <= 1e-12);
  CHECK(closest.at.t >= 8 - 1e-12);
  CHECK(closest.at.t <= 12 + 1e-12);
  CHECK(closest.at.status == Status::clear);
  CHECK(std::abs(closest.at.normal[1] - 0.6) < 1e-12);
  // Not so far.
  query.distance = 4;
  closest = ask();
  CHECK(std::abs(closest.lo - std::sqrt(16 + 9 + 16.0)) < 1e-12);
  CHECK(closest.at.t == 4);
  // It is a pass of what it keeps clear of, whatever else is asked, and the surfaces' distance.
  query.distance = 40;
  query.clearance = 6;
  query.anyHit = true;
  CHECK(std::abs(ask().lo - 5) < 1e-12);
  query.exclude = {0};
  closest = ask();
  CHECK(std::isinf(closest.lo));
  CHECK(std::isinf(closest.hi));
  CHECK(closest.at.object == kNone);
}

TEST_CASE("of grids that slide along each other, few pairs of triangles are looked at, however far the way leads") {
  Scene scene;
  const MeshId grid = add(scene, tools::makeGrid(32, tools::Diagonal::rising, [](uint32_t x, uint32_t y) {
                            return Vec3{0.125 * x, 0.125 * y, 0};
                          }));
  const auto [start, way, distance] = GENERATE(std::tuple{Vec3{0.05, 0, 0.3}, Vec3{1, 0.3, 0}, 3.0},
                                               std::tuple{Vec3{-8.2, 0.02, 0.3}, Vec3{1, 0, 0}, 16.0},
                                               std::tuple{Vec3{-8.2, 0.02, 0.3}, Vec3{1, 0.3, 0.01}, 1e308});
  CAPTURE(start[0], distance);
  scene.addObject({grid, at(0, 0, 0)});
  Query query{.mesh = grid, .worldFromMesh = tools::placedAt(start), .direction = way, .distance = distance};
  query.closest = true;
  const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
  const Closest& closest = *answers.lists[0].closest;
  CHECK(closest.lo >= 0.29);
  CHECK(closest.hi <= 0.4);
  CHECK(closest.hi - closest.lo < 1e-12);
  CHECK(answers.stats.pairs < 6000);
}

TEST_CASE("a step that ends a rounding before contact is that near, and not within less") {
  Scene scene;
  const MeshId mesh = scene.addMesh(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 1}, std::vector<uint32_t>{0, 1, 2});
  scene.addObject({mesh, at(1, 0, 0)});
  for (const double rest : {0x1p-20, 0x1p-40, 0x1p-45, 0x1p-50, 0x1p-52}) {
    CAPTURE(rest);
    Query query{.mesh = mesh, .motion = Vector{1 - rest, 0, 0}, .closest = true};
    const Closest closest = *CpuSweeper(scene, 1).run({&query, 1}).lists[0].closest;
    CHECK(closest.lo <= rest);
    CHECK(closest.hi >= rest);
    CHECK(closest.hi <= 1.001 * rest);
    query.closest = false;
    query.exit = true;
    query.clearance = 0.5 * rest;
    const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
    CHECK(answers.results[0].status != Status::hit);
    CHECK(answers.lists[0].exit->status != Status::hit);
  }
}

TEST_CASE("an exit at about the clearance from the end is not after the end") {
  Scene scene;
  const MeshId mesh = scene.addMesh(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 1}, std::vector<uint32_t>{0, 1, 2});
  scene.addObject({mesh, at(0, 0, 0)});
  for (int ulps = 0; ulps < 200; ++ulps) {
    Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 1 + ulps * 0x1p-52, .clearance = 1, .exit = true};
    const Result exit = *CpuSweeper(scene, 1).run({&query, 1}).lists[0].exit;
    CAPTURE(ulps, exit.lo, exit.hi);
    REQUIRE(exit.hi <= query.distance);
    REQUIRE(exit.hi >= 1);
    REQUIRE(exit.lo <= 1);
  }
}

TEST_CASE("what touches on its way has no distance, and its closest approach is the contact") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  scene.addObject({mesh, at(0, 0, 0)});
  for (const bool anyHit : {false, true}) {
    Query query{.mesh = mesh, .worldFromMesh = at(-10, 2, 0), .direction = {1, 0, 0}, .distance = 40, .anyHit = anyHit};
    query.closest = true;
    const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
    const Closest& closest = *answers.lists[0].closest;
    CHECK(closest.lo == 0);
    CHECK(closest.hi == 0);
    CHECK(closest.at.status == Status::hit);
    CHECK(closest.at.t == 8);
    CHECK(closest.at.object == 0);
  }
}

TEST_CASE("the way out of what overlaps is where the last contact ends") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1)), wall = add(scene, tools::makeBox({10, 10, 1}));
  scene.addObject({wall, at(0, 0, 0)});
  Query query{.mesh = mesh, .worldFromMesh = at(0, 0, 0.25), .direction = {0, 0, 3}, .distance = 40, .exit = true};
  const auto ask = [&] { return *CpuSweeper(scene, 1).run({&query, 1}).lists[0].exit; };
  Result exit = ask();
  CHECK(exit.status == Status::hit);
  CHECK(exit.lo <= 1.25);
  CHECK(exit.hi >= 1.25);
  CHECK(exit.hi - exit.lo < 1e-14);
  CHECK(exit.object == 0);
  CHECK(exit.normal == Vec3{0, 0, 1});
  SECTION("an enclosed shape, without contact at the start, has one too") {
    query.worldFromMesh = tools::makePose({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.25, 0.25, 0.25}, {0, 0, 0});
    CHECK(std::abs(ask().hi - 0.75) < 1e-14);
  }
  SECTION("something later on the way counts, too") {
    scene.addObject({wall, at(0, 0, 20)});
    CHECK(std::abs(ask().hi - 21.25) < 1e-13);
    CHECK(ask().object == 1);
    query.exclude = {0, 1};
    CHECK(ask().status == Status::clear);
  }
  SECTION("a way that is too short ends in contact") {
    query.distance = 1;
    exit = ask();
    CHECK(exit.lo == 1);
    CHECK(exit.hi == 1);
    query.distance = 1.25;
    CHECK(ask().lo == 1.25);
  }
  SECTION("with a clearance, it is out when it is that far away") {
    query.clearance = 0.5;
    exit = ask();
    CHECK(exit.status == Status::hit);
    CHECK(exit.lo <= 1.75);
    CHECK(exit.hi >= 1.75);
    CHECK(exit.hi - exit.lo < 1e-11);
    CHECK(std::abs(exit.gap - 0.5) < 1e-11);
    query.distance = 1;
    CHECK(ask().lo == 1);
  }
  SECTION("a ball, too, and one that passes a face before it leaves an edge") {
    const RoundShape round = ball(2);
    query.mesh = scene.addMesh(round.positions, round.indices);
    query.clearance = round.radius;
    query.worldFromMesh = at(0, 6, 0);
    exit = ask();
    CHECK(std::abs(exit.lo - (0.5 + std::sqrt(3.0))) < 1e-11);
    CHECK(std::abs(exit.hi - (0.5 + std::sqrt(3.0))) < 1e-11);
    CHECK(exit.featureB == Feature::edge);
  }
  SECTION("objects that move are left relative to them") {
    scene.setMotion(0, {0, 0, -2});
    query.direction = {};
    query.distance = 0;
    query.motion = Vec3{0, 0, 3};
    exit = ask();
    CHECK(std::abs(exit.lo - 0.25) < 1e-15);
    CHECK(std::abs(exit.hi - 0.25) < 1e-15);
    query.clearance = 0.5;
    CHECK(std::abs(ask().hi - 0.35) < 1e-11);
    CHECK(std::abs(ask().lo - 0.35) < 1e-11);
  }
}

TEST_CASE("closest approach and exit are refused beside turns and what may leave") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 1, .ignoreLeaving = true, .closest = true};
  CHECK(validate(query, scene) == "closest: expected neither a turn nor ignoreLeaving beside it");
  query = {.mesh = mesh, .turn = Turn{{0, 0, 1}, 1, {}}, .exit = true};
  CHECK(validate(query, scene) == "exit: expected neither a turn nor ignoreLeaving beside it");
  query = {.mesh = mesh, .direction = {1, 0, 0}, .distance = 1, .exit = true};
  CHECK(validate(query, scene).empty());
  CHECK(validate(query, scene, Mode::sampled).find("got sampled") != std::string::npos);
}
