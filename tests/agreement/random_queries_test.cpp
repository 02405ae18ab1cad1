// A small share of what radar_random_queries asks by the hundred thousand.
#include "agreement/real_meshes.h"

#include <catch2/catch.hpp>

#include "support/test_device.h"

using namespace radar;

TEST_CASE("random queries of every family get the CPU's answer on the device") {
  const tools::MeshFamilies meshes = test::realMeshes();
  tools::RandomQueries asking(test::device(), meshes);
  for (const std::string& family : tools::randomFamilies(meshes)) {
    CAPTURE(family);
    const uint64_t queries = 130;  // three scenes
    const auto onWrong = [](uint64_t query, const std::string& words) {
      UNSCOPED_INFO("query " << query << ": " << words);
    };
    const tools::RandomTally tally = asking.run({family, 1, 0, queries}, onWrong, [](uint64_t) {});
    CHECK(tally.queries == queries);
    CHECK(tally.wrong == 0);
    CHECK(tally.worstError <= 1e-12);
    CHECK(tally.hits >= 5);
  }
}

TEST_CASE("a random query is the same whichever queries are asked before it") {
  tools::RandomQueries asking(test::device());
  const auto nothing = [](uint64_t, const std::string&) {};
  const auto run = [&](uint64_t first, uint64_t queries) {
    return asking.run({"touching", 5, first, queries}, nothing, [](uint64_t) {});
  };
  const tools::RandomTally whole = run(60, 10);
  tools::RandomTally parts;
  for (uint64_t i = 60; i < 70; ++i) parts.add(run(i, 1));
  CHECK(parts.queries == 10);
  CHECK(parts.hits == whole.hits);
  CHECK(parts.overlaps == whole.overlaps);
}
