// Hard cases in which the sensor turns.
#include <map>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/seeds.h"
#include "support/world.h"
#include "unit/turn_truth.h"
#include "workloads/turning_families.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr int kTimes = 40;  // at which nothing may meet

}  // namespace

TEST_CASE("hard cases of every turning family meet nothing before lo, and certainly something at hi") {
  const uint32_t seed = GENERATE(from_range(test::seeds({1})));
  std::map<Status, int> all;
  for (const HardFamily& family : turningFamilies()) {
    std::map<Status, int> statuses;
    for (uint64_t number = 0; number < 40; ++number) {
      const HardCase hard = hardCase(family, seed, number);
      const double value = family.values[number % family.values.size()];
      const auto [scene, queries] = test::caseOf(sceneOf({hard}, Company::isolated));
      const Query& query = queries[0];
      const Result found = CpuSweeper(scene, 1).run({&query, 1}).results[0];
      ++statuses[found.status];
      CAPTURE(seed, family.name, number, value, static_cast<uint32_t>(found.status), found.lo, found.hi);
      const test::TurnTruth truth(query, scene);
      // Of what doubles keep of places so far from the origin.
      const Vec3 arm = query.turn->centre;
      const double rounding = 1e-10 + 1e-14 * (1 + std::abs(arm[0]) + std::abs(arm[1]) + std::abs(arm[2]));
      const bool touches = found.status == Status::hit || found.status == Status::overlap;
      const double free = found.status == Status::clear ? 1 : found.lo;
      for (int k = 0; k <= kTimes && free > 0; ++k) REQUIRE(!truth.meet((1 - 1e-12) * free * k / kTimes, rounding));
      if (touches && found.hi > 0) REQUIRE(truth.meet(found.hi, 0));
      CHECK(found.status != Status::invalid);
      // Corners that pass a wall a size deep, or leave it a gap, are seen to do so.
      if (family.name == "turning by" && value >= 1e-5) CHECK(touches);
      if (family.name == "turning by" && value > 0) CHECK(found.status != Status::clear);
      if (family.name == "turning by" && value <= -1e-5) CHECK(found.status == Status::clear);
    }
    for (const auto& [status, count] : statuses) all[status] += count;
    CAPTURE(seed, family.name, statuses[Status::hit], statuses[Status::clear], statuses[Status::overlap],
            statuses[Status::undecided]);
    CHECK(statuses[Status::hit] + statuses[Status::overlap] >= 5);
    if (family.name == "turning edges" || family.name == "far centre") CHECK(statuses[Status::undecided] == 0);
  }
  CAPTURE(seed, all[Status::hit], all[Status::clear], all[Status::overlap], all[Status::undecided]);
  CHECK(all[Status::hit] > 100);
  CHECK(all[Status::clear] > 50);
}
