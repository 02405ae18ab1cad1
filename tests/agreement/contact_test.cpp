// The search on the device against the CPU's, on seeded workloads of every kind.
#include <catch2/catch.hpp>
#include <cmath>

#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "support/answer.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::compareContact;
using test::ContactTally;

}  // namespace

TEST_CASE("on soups of every kind contact is the CPU's answer") {
  const uint64_t seed = GENERATE(1, 2, 3);
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const uint32_t triangles = GENERATE(20, 70, 200);
  CAPTURE(seed, origin, triangles);
  const ContactTally tally = compareContact(
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = triangles, .origin = origin, .seed = seed}));
  CHECK(tally.hits >= 5);
  CHECK(tally.overlaps > 0);
}

TEST_CASE("among soups of one kind contact is the CPU's answer") {
  const tools::Soup kind = GENERATE(from_range(tools::kSoups));
  const double origin = GENERATE(0.0, 1e5);
  CAPTURE(tools::nameOf(kind), origin);
  const ContactTally tally = compareContact(
      tools::makeWorkload(tools::Soups{.kinds = {kind}, .sensors = 48, .triangles = 64, .origin = origin, .seed = 21}));
  CHECK(tally.hits + tally.overlaps > 0);
}

TEST_CASE("a step of one rounding around the exact distance decides between hit and clear as the CPU does") {
  const double origin = GENERATE(0.0, 1e4);
  const tools::Workload workload =
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = 60, .origin = origin, .seed = 31});
  tools::ScenePlayer player(workload);
  player.show(0);
  CpuSweeper cpu(player.scene());
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) {
    Query query = tools::toQuery(spec, Mode::contact);
    const Result exact = test::answer(cpu, query);
    if (exact.status != Status::hit) continue;
    for (double distance : {exact.t, exact.lo, exact.hi, std::nextafter(exact.t, 0), std::nextafter(exact.t, 1e300),
                            std::nextafter(exact.lo, 0), std::nextafter(exact.hi, 1e300)}) {
      query.distance = distance;
      queries.push_back(query);
    }
  }
  const ContactTally tally = compareContact(player.scene(), queries);
  CHECK(tally.hits >= 10);
  CHECK(tally.clear >= 10);
}

TEST_CASE("on Table 1 contact is the CPU's answer") {
  const auto shape = GENERATE(tools::SensorShape::box, tools::SensorShape::teapot);
  const ContactTally tally = compareContact(tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape}));
  CHECK(tally.hits >= 20);
}

TEST_CASE("on Figure 7 contact is the CPU's answer, step after step") {
  const ContactTally tally = compareContact(tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12}));
  CHECK(tally.hits >= 20);
}

TEST_CASE("on assimp's test models contact is the CPU's answer") {
  const ContactTally tally = compareContact(
      tools::makeWorkload(tools::RandomPoses{.meshes = test::assimpModels(), .objects = 300, .sensors = 40}));
  CHECK(tally.hits >= 10);
}

TEST_CASE("on CGAL's meshes contact is the CPU's answer") {
  const ContactTally tally = compareContact(
      tools::makeWorkload(tools::RandomPoses{.meshes = test::cgalMeshes(), .objects = 300, .sensors = 40}));
  CHECK(tally.hits >= 10);
}
