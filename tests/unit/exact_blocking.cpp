// Compares the decisions on pairs that block or cross with the definition in exact integers.
#include "blocking_oracle.h"
#include "exact/blocking.h"
#include "soups.h"
#include "support/catch.h"

using radar::Vector;
using radar::exact::Triangle;
using soups::latticeTriangle;
using soups::Random;

namespace {

struct Counts {
  int blocking = 0, passing = 0, crossing = 0, flush = 0;
};

void check(const Triangle& a, const Triangle& b, const Vector& direction, double slack, Counts& counts) {
  for (const bool mirroredA : {false, true}) {
    const bool mirroredB = a[0][0] > b[0][0];
    const oracle::ScaledPair pair(a, mirroredA, b, mirroredB, slack);
    const oracle::IntVec scaled = oracle::scaled(direction, oracle::leastExponent(direction.data(), 3));
    const bool truth = oracle::blocks(pair.a, pair.b, scaled, pair.slack);
    REQUIRE(radar::exact::blocks(a, b, direction, slack, {mirroredA, mirroredB}) == truth);
    ++(truth ? counts.blocking : counts.passing);
    counts.flush += oracle::areFlush(pair.a, pair.b, pair.slack);
  }
  const oracle::ScaledPair pair(a, false, b, false, slack);
  const bool truth = oracle::cross(pair.a, pair.b, pair.slack);
  REQUIRE(radar::exact::cross(a, b, slack) == truth);
  counts.crossing += truth;
}

void jitter(Random& random, Triangle& t, double by) {
  for (Vector& c : t) {
    for (double& v : c) v += random.uniform(-by, by);
  }
}

}  // namespace

TEST_CASE("blocking and crossing of lattice triangles follow the definition") {
  Random random(1);
  Counts counts;
  for (int i = 0; i < 2500; ++i) {
    INFO("case " << i);
    const int side = random.integer(1, 3);
    check(latticeTriangle(random, side), latticeTriangle(random, side), random.latticeVector(2), 0, counts);
  }
  REQUIRE(counts.blocking > 100);
  REQUIRE(counts.passing > 1000);
  REQUIRE(counts.crossing > 20);
}

TEST_CASE("triangles in one plane that face each other block by the direction alone") {
  Random random(2);
  Counts counts;
  for (int i = 0; i < 1000; ++i) {
    INFO("case " << i);
    Triangle a = latticeTriangle(random, 3), b = latticeTriangle(random, 3);
    for (Triangle* t : {&a, &b}) {
      for (Vector& c : *t) c[2] = 1;
    }
    check(a, b, random.latticeVector(2), 0, counts);
  }
  REQUIRE(counts.flush > 100);
}

TEST_CASE("blocking and crossing with slack follow the definition") {
  Random random(3);
  Counts counts;
  for (int i = 0; i < 2000; ++i) {
    INFO("case " << i);
    Triangle a = latticeTriangle(random, 2), b = latticeTriangle(random, 2);
    const double slack = random.chance(0.5) ? random.uniform(0, 0.6) : 0.25 * random.integer(0, 4);
    if (random.chance(0.5)) {
      jitter(random, a, 0.2);
      jitter(random, b, 0.2);
    }
    check(a, b, random.chance(0.5) ? random.latticeVector(2) : random.inBall(), slack, counts);
  }
  REQUIRE(counts.blocking > 100);
  REQUIRE(counts.passing > 1000);
}

TEST_CASE("blocking and crossing follow the definition where triangles almost touch") {
  Random random(4);
  Counts counts;
  for (int i = 0; i < 2000; ++i) {
    INFO("case " << i);
    // Doubles decide at sizes around 1, integers at others.
    const int most = random.chance(0.5) ? 40 : 300;
    const double scale = std::ldexp(1.0, random.integer(-most, most));
    Triangle a = latticeTriangle(random, 2), b = latticeTriangle(random, 2);
    jitter(random, a, 0x1p-52);
    if (random.chance(0.5)) jitter(random, b, 0x1p-52);
    for (Triangle* t : {&a, &b}) {
      for (Vector& c : *t) {
        for (double& v : c) v *= scale;
      }
    }
    const double slack = random.chance(0.3) ? 0 : scale * radar::exact::defaultSlack(random.uniform(0.1, 3));
    check(a, b, random.latticeVector(2), slack, counts);
  }
  REQUIRE(counts.blocking > 100);
  REQUIRE(counts.passing > 1000);
}
