// Queries with a clearance: compares the CPU's answers with brute force.
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cpu/approach.h"
#include "exact/translation.h"
#include "nearness_truth.h"
#include "radar/cpu_sweeper.h"
#include "scene_kinds.h"
#include "support/catch.h"

using namespace radar;
using soups::Random;
using test::add;
using test::at;
using test::placeOf;
using tools::operator+;
using tools::operator-;
using tools::operator*;
using tools::turned;
using tools::Vec3;

namespace {

Translation along(const Vector& direction, double distance) {
  return Translation(Query{.direction = direction, .distance = distance});
}

struct Counts {
  int hit = 0, clear = 0, overlap = 0, undecided = 0;
};

void check(const Scene& scene, const Query& query, const Result& result, Counts& counts) {
  REQUIRE(oracle::NearTruth(scene, query).faultOf(result, {}, {}) == "");
  ++(result.status == Status::clear     ? counts.clear
     : result.status == Status::overlap ? counts.overlap
     : result.status == Status::hit     ? counts.hit
                                        : counts.undecided);
  // Along the line between the nearest points.
  const bool isUnit = std::abs(std::hypot(result.normal[0], result.normal[1], result.normal[2]) - 1) <= 1e-14;
  if (result.status == Status::hit) REQUIRE(isUnit);
}

void runSoup(uint64_t seed, double scale, double far, Counts& counts) {
  Random random(seed);
  Scene scene;
  const Vec3 centre{far * random.uniform(-1, 1), far * random.uniform(-1, 1), far};
  const auto near = [&] { return centre + 4 * scale * random.inBall(); };
  for (int m = 0; m < 2; ++m) {
    add(scene, soups::soup(random, random.integer(1, 6), random.uniform(0.05, 0.7), 0.2));
  }
  for (int i = random.integer(1, 3); i-- > 0;) {
    scene.addObject({1, random.pose(scale * random.uniform(0.3, 2), near())});
  }
  std::vector<Query> queries(3);
  for (Query& query : queries) {
    query = {.mesh = 0, .worldFromMesh = random.pose(scale * random.uniform(0.3, 1), near())};
    query.direction = placeOf(scene.object(0).worldFromMesh) - placeOf(query.worldFromMesh) + scale * random.inBall();
    query.distance = scale * random.uniform(0, 12);
    query.clearance = scale * (random.chance(0.8) ? std::exp(random.uniform(-7, 1)) : random.magnitude(-11, -8));
    if (random.chance(0.5)) query.tolerance = scale * std::exp(random.uniform(-20, -3));
    query.ignoreLeaving = random.chance(0.5);
  }
  const std::vector<Result> results = CpuSweeper(scene, 2).run(queries).results;
  for (size_t q = 0; q < queries.size(); ++q) {
    INFO("seed " << seed << " scale " << scale << " far " << far << " query " << q);
    check(scene, queries[q], results[q], counts);
  }
}

}  // namespace

TEST_CASE("contact with a clearance begins when the surfaces come that near") {
  Counts counts;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    runSoup(seed, 1, 0, counts);
    runSoup(1000 + seed, 1e-4, 1, counts);
    runSoup(2000 + seed, 1e4, 1e6, counts);
  }
  REQUIRE(counts.hit > 60);
  REQUIRE(counts.clear > 60);
  REQUIRE(counts.overlap > 10);
  REQUIRE(counts.undecided == 0);
}

TEST_CASE("a clearance of 1e-300 gives what none gives, where surfaces touch exactly") {
  int contacts = 0;
  for (const kinds::Kind& kind : kinds::all()) {
    const std::string_view name = kind.name;
    if (name != "integer lattices" && name != "boxes on a lattice" && name != "boxes pressed together") continue;
    for (uint64_t seed = 0; seed < (name == "boxes pressed together" ? 3 : 60); ++seed) {
      Random random(seed);
      test::Case one;
      kind.make(random, one);
      CpuSweeper sweeper(one.scene, 1);
      const std::vector<Result> plain = sweeper.run(one.queries).results;
      for (Query& query : one.queries) query.clearance = 1e-300;
      const std::vector<Result> near = sweeper.run(one.queries).results;
      for (size_t i = 0; i < near.size(); ++i) {
        INFO(name << ", scene " << seed << ", query " << i);
        REQUIRE(near[i].status == plain[i].status);
        if (near[i].status == Status::clear) continue;
        ++contacts;
        CHECK((near[i].lo <= plain[i].hi && plain[i].lo <= near[i].hi && near[i].hi <= one.queries[i].distance));
        CHECK(near[i].hi - near[i].lo <= 1e-5);
        // What is pressed together may have sunk in.
        CHECK((near[i].gap <= one.queries[i].slack.value_or(0) + 1e-12 && std::isfinite(near[i].point[0])));
        if (near[i].status == Status::overlap && !one.queries[i].ignoreLeaving)
          CHECK((near[i].object == plain[i].object && near[i].triB == plain[i].triB));
      }
    }
  }
  CHECK(contacts > 250);
}

TEST_CASE("boxes pressed together block though they have sunk in by more than the clearance, within the slack") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({box, at(0, 0, 0)});
  Query query{.mesh = box, .worldFromMesh = at(0, 0, 1 - 5e-4), .direction = {0, 0, -1}, .distance = 0.5};
  query.ignoreLeaving = true;
  query.slack = 1e-3;
  for (const double clearance : {0.0, 1e-300, 1e-4, 5e-4, 1e-3, 2e-3, 0.1}) {
    query.clearance = clearance;
    const Result result = CpuSweeper(scene, 1).run({&query, 1}).results[0];
    CAPTURE(clearance);
    CHECK(result.status == Status::overlap);
    CHECK((result.object == 0 && result.gap == Approx(clearance > 0 ? 5e-4 : 0)));
  }
}

TEST_CASE("a box stops at its clearance before a wall, an edge and a corner") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({box, at(5, 0, 0)});
  Query query{.mesh = box, .direction = {3, 0, 0}, .distance = 10};
  query.clearance = 0.25;
  const auto move = [&] { return CpuSweeper(scene, 1).run({&query, 1}).results[0]; };
  CHECK(move().t == Approx(3.75).epsilon(1e-6));
  CHECK(move().hi - move().lo <= 1e-6);
  query.tolerance = 0;
  CHECK(move().t == Approx(3.75).epsilon(1e-12));
  CHECK(move().hi - move().lo <= 1e-12);
  // Past the edge at a height of 0.15: the distance is that of the edges, sqrt(0.15^2 + x^2).
  query.worldFromMesh = at(0, 1.15, 0);
  CHECK(move().t == Approx(4 - 0.2).epsilon(1e-12));
  // Past the corner, 0.15 and 0.12 beside it.
  query.worldFromMesh = at(0, 1.15, 1.12);
  CHECK(move().t == Approx(4 - std::sqrt(0.25 * 0.25 - 0.15 * 0.15 - 0.12 * 0.12)).epsilon(1e-12));
  query.worldFromMesh = at(0, 1.15, 1.24);
  CHECK(move().status == Status::clear);
  query.worldFromMesh = at(3.9, 0, 0);
  CHECK(move().status == Status::overlap);
}

TEST_CASE("needles that pass by a hair are not certified as within a smaller clearance") {
  // Each 1e8 times as long as wide; 2.2e-9 apart.
  const exact::Triangle a{{{0x1.aa51c62c6ad3ep-5, 0x1.3897dc1b0c184p-1, -0x1.3e93f252e8b33p-1},
                           {0x1.aa4d94e6ab9b4p-1, 0x1.dad18ed17d042p-3, -0x1.ffb43ec88ae9fp-4},
                           {0x1.ac8e94f82e196p-2, 0x1.16235818f9b22p+0, 0x1.84960350bfb79p-2}}};
  const exact::Triangle b{{{0, 0, 0},
                           {0x1.3c51124454f07p-1, 0x1.2d32801c4f815p-1, -0x1.0b25d7eda9225p-1},
                           {0x1.182d76eb6f728p-1, 0x1.0ac91a8e403e8p-1, -0x1.d940a4fe60dcap-2}}};
  for (const double clearance : {1e-9, 1e-11, 2e-14}) {
    const auto found = cpu::approach(a, b, along({1, 0, 0}, 0), clearance, 0, INFINITY);
    CHECK((!found || std::isinf(found->hi)));
  }
}

TEST_CASE("a point that passes through a triangle a billion times the clearance is certainly within it") {
  // Rounding leaves open where it is; the step that was tried led past the triangle, and there the search gave up.
  const Vector point{-0x1.cda55a2a86fe9p+2, -0x1.210771dd39ee7p+1, 0x1.10ebc01723f03p+3};
  const exact::Triangle face{{{-0x1.130785bcaddp+2, -0x1.fa3a13ef82f8p+4, 0x1.085f40842f5p+5},
                              {0x1.1c2d3e736c3ap+8, 0x1.2530135cfd32p+7, 0x1.ea43ec5adfcep+6},
                              {-0x1.301fbc76cda74p+7, -0x1.32f9bb3d7ec4p+6, -0x1.f495f2b0b3acp+5}}};
  const Vector unit{0x1.5cd94169c7b7bp-1, 0x1.bc15da9e3993dp-6, -0x1.7681f9714dbb4p-1};
  const auto found = cpu::approach({point, point, point}, face, along(unit, 11.4), 0x1.57c6b1946ff6ep-22,
                                   0x1.018c861aa4df8p-18, INFINITY);
  REQUIRE(found);
  // By exact arithmetic, it is that near from 7.30117290387 to 7.3011735...
  CHECK((7.301172 < found->lo && found->lo < 7.30117290388));
  CHECK((7.30117290387 < found->hi && found->hi < 7.3011738));
}

TEST_CASE("a bracket is as narrow as rounding allows though doubles do not tell which points are nearest") {
  // Above the end of the last side when it comes within 1: the squares of the distances from there and from beside it
  // are the same number.
  const Vector point{1, -3, 1};
  const exact::Triangle face{{{3, -0.5, 0.5}, {3, -0.5, 1.5}, {2, -0.5, 1.5}}};
  const auto found = cpu::approach({point, point, point}, face, along({2, 1.5, -0.5}, 10), 1, 0, INFINITY);
  REQUIRE(found);
  CHECK(found->lo <= std::sqrt(6.5));
  CHECK(found->hi >= std::sqrt(6.5));
  CHECK(found->hi - found->lo <= 1e-12);
}

TEST_CASE("a clearance works at every scale") {
  for (const double scale : {1e-160, 1e-30, 1e30, 1e150}) {
    const exact::Triangle a{{{0, 0, 0}, {0, scale, 0}, {0, 0, scale}}};
    exact::Triangle b = a;
    for (Vector& corner : b) corner[0] = 4 * scale;
    const auto found = cpu::approach(a, b, along({1, 0, 0}, 10 * scale), scale, 1e-6 * scale, INFINITY);
    REQUIRE(found);
    CHECK(found->lo / scale == Approx(3).epsilon(1e-5));
    CHECK(found->hi / scale == Approx(3).epsilon(1e-5));
    CHECK((found->lo <= 3 * scale && 3 * scale <= found->hi));
  }
}

TEST_CASE("an object that passes at the clearance, to rounding, widens the bracket and is listed") {
  Scene scene;
  // The cube [0, 1]^3.
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({box, at(5, 0, 0)});
  scene.addObject({box, at(6, 0.2, 0)});
  const ObjectId beside = scene.addObject({box, at(2.5, 1.25, 0)});
  Query query{.mesh = box, .direction = {1, 0, 0}, .distance = 10};
  query.clearance = 0.25;
  CpuSweeper sweeper(scene, 1);
  for (const uint32_t hits : {1u, 2u, 3u, kAllHits}) {
    query.hits = hits;
    const Answers answers = sweeper.run({&query, 1});
    const Result& result = answers.results[0];
    CAPTURE(hits);
    CHECK(result.object == 0);
    CHECK(result.lo <= 1.5);
    CHECK(result.lo >= 1.4999);
    CHECK(result.t == result.lo);
    CHECK(result.hi == Approx(3.75));
    if (hits == 1) continue;
    const std::vector<Result>& listed = answers.lists[0].hits;
    REQUIRE(listed.size() == 3);
    CHECK((listed[0].object == beside && listed[0].status == Status::undecided && listed[0].hi == INFINITY));
    CHECK((listed[1].object == 0 && listed[2].object == 1));
  }
}

namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

/// A sliver, 1 to 4 from the origin, `stretch` times as long as wide.
exact::Triangle sliver(Random& random, double stretch) {
  const tools::Rotation turn = random.rotation();
  const size_t axis = random.below(3);
  const Vec3 at = 3 * random.inBall();
  exact::Triangle triangle;
  for (Vector& corner : triangle) {
    Vec3 p = random.inBall();
    p[axis] *= stretch;
    corner = turned(turn, p) + at;
  }
  return triangle;
}

}  // namespace

TEST_CASE("slivers up to 1e13 times as long as wide are decided, though doubles would leave them open") {
  for (const double stretch : {1.0, 1e5, 1e7, 1e9, 1e11, 1e13}) {
    int hits = 0, wide = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
      Random random(seed);
      const exact::Triangle a = sliver(random, stretch), b = sliver(random, stretch);
      Query query{.direction = random.inBall(), .distance = random.chance(0.5) ? 10 : 10 * stretch};
      const Translation motion(query);
      const double clearance = std::exp(random.uniform(-7, 1)), tolerance = 1e-6;
      const auto found = cpu::approach(a, b, motion, clearance, tolerance, INFINITY);
      const distances::Point<Quad> unit = distances::pointOf<Quad>(motion.direction).normalized();
      const auto placedA = distances::pointsOf<Quad>(a), placedB = distances::pointsOf<Quad>(b);
      const Quad room = 1e-24 * stretch;
      CAPTURE(stretch, seed, clearance);
      const double before = found ? found->lo : query.distance;
      if (before > 0) CHECK(distances::leastDistance(placedA, placedB, unit, Quad(before), 100) >= clearance - room);
      if (!found) continue;
      ++hits;
      CHECK(found->hi <= 1.01 * query.distance);  // known
      CHECK(distances::distanceAt(placedA, placedB, unit, Quad(found->hi)) <= clearance + room);
      wide += found->hi - found->lo > 2 * tolerance + 0x1p-50 * found->hi;
    }
    CAPTURE(stretch);
    CHECK(hits > 2);
    if (stretch < 1e12) CHECK(wide == 0);
  }
}

TEST_CASE("a clearance larger than the shapes opens few pairs of triangles, before a gap and within one") {
  Scene scene;
  const MeshId shape = add(scene, tools::makeUvSphere(20, 20));
  for (int i = 0; i < 4; ++i) scene.addObject({shape, at(3.0 * (i % 2), 3.0 * (i / 2), 0)});
  Query query{.mesh = shape, .worldFromMesh = at(-30, -30.1, -30.2), .direction = {1, 1, 1}, .distance = 300};
  query.clearance = 12;
  const auto move = [&] { return CpuSweeper(scene, 1).run({&query, 1}); };
  CHECK(move().results[0].status == Status::hit);
  const uint64_t all = 4 * scene.mesh(shape).triangleCount() * scene.mesh(shape).triangleCount();
  CHECK(move().stats.pairs < all / 100);
  query.clearance = 120;
  CHECK(move().results[0].status == Status::overlap);
  CHECK(move().stats.pairs < all / 100);
}

TEST_CASE("of shapes that leave each other, a clearance larger than they opens few pairs of triangles") {
  Scene scene;
  const MeshId shape = add(scene, tools::makeUvSphere(20, 20));
  scene.addObject({shape, at(-3, 0.1, 0.2)});
  Query query{.mesh = shape, .worldFromMesh = at(0, 0, 0), .direction = {1, 0, 0}, .distance = 300};
  query.clearance = 12;
  query.ignoreLeaving = true;
  const auto move = [&] { return CpuSweeper(scene, 1).run({&query, 1}); };
  const uint64_t all = uint64_t{scene.mesh(shape).triangleCount()} * scene.mesh(shape).triangleCount();
  CHECK(move().results[0].status == Status::clear);
  CHECK(move().stats.pairs < all / 100);
  const ObjectId ahead = scene.addObject({shape, at(13, 0, 0)});
  CHECK(move().results[0].status == Status::overlap);
  CHECK(move().results[0].object == ahead);
  CHECK(move().stats.pairs < all / 10);
}

TEST_CASE("where a corner, an edge or a face decides, a clearance's bracket is as narrow as rounding allows") {
  Random random(7);
  const auto point = [](const Vector& p) { return exact::Triangle{p, p, p}; };
  // The object's farthest corner, along x, and how far beside the way of the sensor's point it is.
  const exact::Triangle corner = point({0, 0, 0}), edge{{{0, 0, -9}, {0, 0, 9}, {0, 0, 9}}},
                        face{{{0, -99, -99}, {0, 99, -99}, {0, 0, 99}}};
  for (int i = 0; i < 1'000; ++i) {
    const double y = random.uniform(-0.9, 0.9), z = random.uniform(-0.4, 0.4), x = random.uniform(2, 50);
    const auto widthAt = [&](const exact::Triangle& object, long double before) {
      const auto found = cpu::approach(point({-x, y, z}), object, along({1, 0, 0}, 100), 1, 1e-3, INFINITY);
      REQUIRE(found);
      CAPTURE(x, y, z, found->lo, found->hi);
      CHECK((found->lo <= x - before && x - before <= found->hi));
      return found->hi - found->lo;
    };
    CHECK(widthAt(corner, std::sqrt(1 - static_cast<long double>(y) * y - static_cast<long double>(z) * z)) < 1e-10);
    CHECK(widthAt(edge, std::sqrt(1 - static_cast<long double>(y) * y)) < 1e-10);
    CHECK(widthAt(face, 1) < 1e-10);
  }
}
