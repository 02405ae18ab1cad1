// Compares the decisions on pairs that block or cross with the definition in exact integers.
#include "blocking_oracle.h"
#include "exact/blocking.h"
#include "soups.h"
#include "support/catch.h"

using radar::Vector;
using radar::tools::operator+;
using radar::tools::operator*;
using radar::exact::Triangle;
using soups::latticeTriangle;
using soups::Random;

namespace {

struct Counts {
  int blocking = 0, passing = 0, crossing = 0, flush = 0;
};

void jitter(Random& random, Triangle& t, double by) {
  for (Vector& c : t) c = c + random.inCube(by);
}

/// Two triangles, a direction and a slack.
struct Pair {
  Triangle a, b;
  Vector direction;
  double slack = 0;
  double distance = 1;
};

Pair lattices(Random& random) {
  const int side = random.integer(1, 3);
  return {latticeTriangle(random, side), latticeTriangle(random, side), random.latticeVector(2)};
}

Pair inOnePlane(Random& random) {
  Pair pair = lattices(random);
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vector& c : *t) c[2] = 1;
  }
  return pair;
}

// Directions that go into the plane by about as much as the slack allows.
Pair almostSliding(Random& random) {
  Pair pair = inOnePlane(random);
  const double tilt = std::ldexp(1.0, -random.integer(10, 60));
  if (random.chance(0.5)) pair.direction = {random.uniform(-1, 1), random.uniform(-1, 1), 0};
  pair.direction[2] = tilt * random.uniform(-1, 1);
  pair.slack = random.chance(0.1) ? 0 : tilt * std::ldexp(random.uniform(0.5, 1), random.integer(-3, 3));
  pair.distance = std::ldexp(random.uniform(0.5, 1), random.integer(-6, 6));
  if (random.chance(0.5)) jitter(random, pair.a, pair.slack);
  return pair;
}

Pair withSlack(Random& random) {
  Pair pair = lattices(random);
  pair.slack = random.chance(0.5) ? random.uniform(0, 0.6) : 0.25 * random.integer(0, 4);
  if (random.chance(0.5)) {
    jitter(random, pair.a, 0.2);
    jitter(random, pair.b, 0.2);
  }
  if (random.chance(0.5)) pair.direction = random.inBall();
  return pair;
}

Pair almostTouching(Random& random) {
  // Doubles decide at sizes around 1, integers at others.
  const int most = random.chance(0.5) ? 40 : 300;
  const double scale = std::ldexp(1.0, random.integer(-most, most));
  Pair pair = lattices(random);
  jitter(random, pair.a, 0x1p-52);
  if (random.chance(0.5)) jitter(random, pair.b, 0x1p-52);
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vector& c : *t) c = scale * c;
  }
  pair.slack = random.chance(0.3) ? 0 : scale * radar::exact::defaultSlack(random.uniform(0.1, 3));
  return pair;
}

void check(const Pair& made, Counts& counts) {
  const auto& [a, b, direction, slack, distance] = made;
  for (const bool mirroredA : {false, true}) {
    const bool mirroredB = a[0][0] > b[0][0];
    const oracle::ScaledPair pair(a, mirroredA, b, mirroredB, slack);
    const double length = radar::exact::length(direction);
    const bool truth =
        oracle::blocks(pair.a, pair.b, oracle::courseOf(direction, distance, length, pair.unit), pair.slack);
    const radar::exact::Way way{direction, distance, length};
    REQUIRE(radar::exact::blocks(a, b, way, slack, {mirroredA, mirroredB}) == truth);
    ++(truth ? counts.blocking : counts.passing);
    counts.flush += oracle::areFlush(pair.a, pair.b, pair.slack);
  }
  const oracle::ScaledPair pair(a, false, b, false, slack);
  const bool truth = oracle::cross(pair.a, pair.b, pair.slack);
  REQUIRE(radar::exact::cross(a, b, slack) == truth);
  counts.crossing += truth;
}

}  // namespace

TEST_CASE(
    "blocking and crossing follow the definition, with and without slack, in one plane and where they almost touch") {
  const struct {
    Pair (*make)(Random& random);
    int pairs;
    Counts least;
  } rows[] = {{lattices, 2500, {100, 1000, 20, 0}},
              {inOnePlane, 1000, {0, 0, 0, 100}},
              {almostSliding, 2000, {50, 50, 0, 100}},
              {withSlack, 2000, {100, 1000, 0, 0}},
              {almostTouching, 2000, {100, 1000, 0, 0}}};
  for (const auto& row : rows) {
    Random random(static_cast<uint64_t>(&row - rows));
    Counts counts;
    for (int i = 0; i < row.pairs; ++i) {
      INFO("row " << &row - rows << ", pair " << i);
      check(row.make(random), counts);
    }
    CAPTURE(&row - rows, counts.blocking, counts.passing, counts.crossing, counts.flush);
    CHECK(counts.blocking >= row.least.blocking);
    CHECK(counts.passing >= row.least.passing);
    CHECK(counts.crossing >= row.least.crossing);
    CHECK(counts.flush >= row.least.flush);
  }
}
