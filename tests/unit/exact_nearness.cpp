// Compares which pairs block a motion with a clearance with the definition, in integers.
#include "exact/nearness.h"

#include "cpu/approach.h"
#include "cpu/first_contact.h"
#include "nearness_oracle.h"
#include "soups.h"
#include "support/catch.h"

using oracle::Integer;
using oracle::IntVec;
using radar::Vector;
using radar::exact::Triangle;
using soups::latticeTriangle;
using soups::Random;

namespace {

IntVec integers(const Vector& v) {
  return {Integer(std::lround(v[0])), Integer(std::lround(v[1])), Integer(std::lround(v[2]))};
}
oracle::IntTriangle integers(const Triangle& t) {
  return {integers(t[0]), integers(t[1]), integers(t[2])};
}

}  // namespace

TEST_CASE(
    "a pair blocks at a distance if it comes nearer than the clearance and than it starts, by more than the slack") {
  Random random(63);
  int blocking = 0, passing = 0, within = 0, constant = 0, leaving = 0, level = 0, told[4] = {};
  for (int i = 0; i < 6000; ++i) {
    INFO("pair " << i);
    const int side = random.integer(1, 4);
    Triangle a = latticeTriangle(random, side), b = latticeTriangle(random, side);
    if (random.chance(0.2)) a = {a[0], a[0], a[0]};
    if (random.chance(0.2)) b = {b[0], b[1], b[1]};
    const Vector direction = random.latticeVector(2);
    // Thirds of a lattice's step.
    for (Triangle* t : {&a, &b}) {
      for (Vector& c : *t) {
        for (double& x : c) x = 3 * std::round(x);
      }
    }
    const int clearance = random.integer(1, 12), slack = random.chance(0.5) ? 0 : random.integer(0, 3);
    const oracle::Nearness nearness = oracle::nearnessOf(integers(a), integers(b), integers(direction));
    const auto& [start, least] = nearness;
    const radar::exact::Way way{direction, 100, radar::exact::length(direction)};
    const double scale = std::ldexp(1.0, random.integer(-60, 60));
    Triangle scaledA = a, scaledB = b;
    for (Triangle* t : {&scaledA, &scaledB}) {
      for (Vector& c : *t) {
        for (double& x : c) x *= scale;
      }
    }
    const bool found = radar::exact::blocksWithin(scaledA, scaledB, {direction, 100 * scale, way.length},
                                                  clearance * scale, slack * scale, {});
    const bool touches = start.num <= Integer(slack * slack) * start.den || clearance <= slack;
    const bool truth =
        touches ? radar::exact::blocks(a, b, way, slack, {}) : oracle::comesNearer(nearness, clearance, slack);
    REQUIRE(found == truth);
    const auto roughly = radar::cpu::nearingOf(scaledA, scaledB, direction, clearance * scale, slack * scale);
    if (roughly == radar::cpu::Nearing::pressed) {
      REQUIRE(touches);
    } else if (roughly != radar::cpu::Nearing::open) {
      REQUIRE((!touches && (roughly == radar::cpu::Nearing::yes) == truth));
    }
    const radar::cpu::PairRule rule{slack * scale, {}};
    const radar::Query query{.direction = direction, .distance = 100 * scale};
    const radar::Translation motion(query);
    const bool isKnown = rule.leaves({scaledA, scaledB}, motion, clearance * scale);
    REQUIRE(rule.blocks({scaledA, scaledB}, motion, clearance * scale) == truth);
    REQUIRE(!(isKnown && truth));
    leaving += isKnown;
    level += isKnown && radar::cpu::staysLevel(scaledA, scaledB, motion.unit, slack * scale);
    ++told[static_cast<size_t>(roughly)];
    ++(truth ? blocking : passing);
    within += !touches && start.num <= Integer(clearance * clearance) * start.den;
    constant += !touches && !oracle::isLess(least, start);
  }
  CAPTURE(blocking, passing, within, constant, leaving, level, told[0], told[1], told[2], told[3]);
  CHECK(blocking > 500);
  CHECK(passing > 500);
  CHECK(within > 300);
  CHECK(constant > 300);
  CHECK(leaving > 100);
  CHECK(level > 100);
  // Lattices are hard: triangles touch, and slide along each other.
  for (const int times : told) CHECK(times > 300);
  CHECK(told[3] < 2000);
}
