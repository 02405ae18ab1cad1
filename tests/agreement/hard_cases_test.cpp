// A small share of what radar_random_queries and `radar-lab stability` ask by the ten thousand.
#include <cmath>

#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "measure/case_run.h"
#include "measure/stability.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using tools::Approach;
using tools::Company;

std::vector<Query> withDistances(const Scene& scene, const tools::Workload& workload) {
  CpuSweeper cpu(scene);
  const std::vector<Query> first = tools::queriesOf(workload.queries);
  std::vector<Query> queries;
  const std::vector<Result> exact = cpu.run(first).results;
  for (size_t i = 0; i < first.size(); ++i) {
    queries.push_back(first[i]);
    if (exact[i].status != Status::hit) continue;
    for (const double distance : {std::nextafter(exact[i].t, 0), exact[i].t, std::nextafter(exact[i].t, INFINITY)}) {
      queries.push_back(first[i]);
      queries.back().distance = distance;
    }
  }
  return queries;
}

/// Checks the cases of every family, of which each must have as many hits, and adds them up.
tools::Tally tallyOf(tools::CaseRange range, const tools::MeshFamilies& meshes = {}, uint64_t hits = 0) {
  tools::CaseRun run(test::device(), meshes);
  tools::Tally all;
  for (const std::string& family : tools::runFamilies(meshes)) {
    CAPTURE(family);
    range.family = family;
    const tools::Tally tally = run.run(range, [](uint64_t number, const Approach&, const std::string& words) {
      UNSCOPED_INFO("case " << number << ": " << words);
    });
    CHECK(tally.queries == range.cases);
    CHECK(tally.wrong == 0);
    CHECK(tally.hits >= hits);
    all.add(tally);
  }
  return all;
}

}  // namespace

TEST_CASE("hard cases of every family in one scene, and real meshes, get the CPU's answer on the device, to the bit") {
  tallyOf({.seed = 1, .cases = 130}, test::realMeshes(), 5);  // three scenes each
}

TEST_CASE("with a clearance, hard cases of every family get the CPU's answer on the device, to the bit") {
  const tools::Tally all = tallyOf({.seed = 4, .cases = 64, .clearances = true});
  CHECK(all.hits > all.queries / 5);
  CHECK(all.overlaps > all.queries / 5);
  CHECK(all.cpuPairs > all.hits);  // the device leaves pairs to the CPU, not whole queries
}

TEST_CASE("where objects move, too, hard cases of every family get the CPU's answer on the device, to the bit") {
  const tools::Tally all = tallyOf({.seed = 5, .cases = 64, .steps = true});
  CHECK(all.hits > all.queries / 5);
  CHECK(all.pairs > all.cpuPairs);  // the device searches, and leaves few pairs to the CPU
}

TEST_CASE("hard cases of every family, each alone, keep every promise of modes sampled and contact") {
  const auto onWrong = [](const std::string& words) { UNSCOPED_INFO(words); };
  const std::vector<tools::HardFamily>& families = tools::hardFamilies();
  tools::Json report = tools::newReport("");
  CHECK(tools::measureStability(test::device(),
                                {.cases = tools::kIsolatedCases * families.size(), .seed = 7, .resolutions = {16, 64}},
                                report, onWrong, [](uint64_t) {}));
  size_t expected = 0;
  for (const tools::HardFamily& family : families) expected += tools::offersSampled(family) ? 5 : 1;
  const tools::Json rows = tools::partOf(report, "table")["rows"], totals = tools::partOf(report, "totals")["rows"];
  CHECK(rows.size() == expected);
  CHECK(totals.size() == 5);
  CHECK(totals.back()["cases"] == tools::kIsolatedCases * families.size());
  for (const tools::Json& row : rows) {
    CAPTURE(row.dump());
    CHECK(row["cases"] == tools::kIsolatedCases);
    CHECK(row["contacts"] >= 5);
  }
}

TEST_CASE("with D at the contact and a rounding beside it, answers and decisions keep every promise") {
  for (const tools::HardFamily& family : tools::hardFamilies()) {
    const tools::Workload workload = tools::hardScene(family, 17, 0, tools::kIsolatedCases, Company::isolated);
    Scene scene;
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries = withDistances(scene, workload);
    CAPTURE(family.name);
    CHECK(queries.size() > workload.queries.size());
    for (const bool decide : {false, true}) {
      for (Query& query : queries) {
        query.anyHit = decide;
        query.resolution = 32;
      }
      test::compare(scene, queries);
      if (tools::offersSampled(family)) test::compare(scene, queries, Mode::sampled);
    }
  }
}

TEST_CASE("the normal where twelve pairs touch at a vertex and an edge does not depend on how corners are numbered") {
  tools::CaseRun run(test::device());
  for (const uint64_t number : {493u, 747u}) {
    const tools::Tally tally = run.run(
        {.family = "interlocking", .seed = 77, .first = number, .cases = 1, .allHits = true},
        [](uint64_t, const Approach&, const std::string&) {}, [](uint64_t) {});
    CHECK(tally.queries == 1);
    CHECK(tally.wrong == 0);
  }
}

TEST_CASE("a case is the same whichever cases are asked before it") {
  tools::CaseRun run(test::device());
  const auto ask = [&](uint64_t first, uint64_t cases) { return run.run({"touching", 5, first, cases}); };
  const tools::Tally whole = ask(60, 10);
  tools::Tally parts;
  for (uint64_t i = 60; i < 70; ++i) parts.add(ask(i, 1));
  CHECK(parts.queries == 10);
  CHECK(parts.hits == whole.hits);
  CHECK(parts.overlaps == whole.overlaps);
}
