// Queries that ask "within D or not" only.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/answer.h"
#include "support/test_device.h"
#include "workloads/families.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;

Status decisionOf(Status status) {
  return status == Status::overlap ? Status::hit : status;
}

std::vector<Query> deciding(std::vector<Query> queries) {
  for (Query& query : queries) query.anyHit = true;
  return queries;
}

void checkDecision(const Query& query, const Result& result, const Result& exact) {
  CHECK(uint32_t(result.status) == uint32_t(decisionOf(exact.status)));
  CHECK((std::isnan(result.t) && std::isnan(result.fraction)));
  CHECK((result.object == kNone && result.triA == kNone && result.triB == kNone));
  CHECK((std::isnan(result.point[0]) && std::isnan(result.normal[0])));
  if (result.status != Status::hit) return;
  CHECK(result.detected == Detected::yes);
  CHECK(result.lo <= exact.hi);
  CHECK(exact.lo <= result.hi);
  CHECK(result.hi <= query.distance);
}

struct Shown {
  explicit Shown(const tools::Workload& workload, Mode mode) : player(workload) {
    player.show(0);
    for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, mode, 64));
  }
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

}  // namespace

TEST_CASE("a decision is that of the whole answer, on the device and on the CPU, at exactly D and beside it too") {
  const tools::Family family = GENERATE(from_range(tools::kFamilies));
  CAPTURE(tools::nameOf(family));
  const tools::Workload workload = tools::makeWorkload(tools::FamilyScene{.family = family, .queries = 96, .seed = 9});
  Shown shown(workload, Mode::contact);
  CpuSweeper cpu(shown.player.scene());
  std::vector<Query> queries = shown.queries;
  for (const Query& query : shown.queries) {
    const Result exact = test::answer(cpu, query);
    if (exact.status != Status::hit) continue;
    for (double distance : {exact.t, std::nextafter(exact.t, 0), std::nextafter(exact.t, 1e300)}) {
      queries.push_back(query);
      queries.back().distance = distance;
    }
  }
  const std::vector<Result> exact = cpu.run(queries);
  queries = deciding(std::move(queries));
  Sweeper sweeper(test::device(), shown.player.scene(), {.cpuBatch = 0});
  const std::vector<Result> swept = sweeper.run(queries), onCpu = cpu.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i, exact[i].t, queries[i].distance);
    checkDecision(queries[i], swept[i], exact[i]);
    checkDecision(queries[i], onCpu[i], exact[i]);
    CHECK((swept[i].tier == Tier::contact || swept[i].tier == Tier::select));
    CHECK(onCpu[i].tier == Tier::reference);
  }
}

TEST_CASE("in mode sampled a decision is that of the whole answer") {
  const tools::Family family =
      GENERATE(tools::Family::convex, tools::Family::interlocking, tools::Family::lattice, tools::Family::touching);
  const tools::Workload workload = tools::makeWorkload(tools::FamilyScene{.family = family, .queries = 64, .seed = 3});
  Shown shown(workload, Mode::sampled);
  Sweeper sweeper(test::device(), shown.player.scene());
  const std::vector<Result> whole = sweeper.run(shown.queries);
  const std::vector<Query> queries = deciding(shown.queries);
  const std::vector<Result> decided = sweeper.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    CHECK(uint32_t(decided[i].status) == uint32_t(decisionOf(whole[i].status)));
    CHECK((std::isnan(decided[i].t) && decided[i].object == kNone && std::isnan(decided[i].point[0])));
    CHECK((decided[i].detected == whole[i].detected && decided[i].resolution == whole[i].resolution));
    if (decided[i].status != Status::hit) continue;
    CHECK(decided[i].lo == 0);
    CHECK(decided[i].hi >= whole[i].hi);
    CHECK(decided[i].hi <= queries[i].distance);
  }
}

TEST_CASE("a decision on a deep overlap costs a fraction of the whole answer") {
  Scene scene;
  const tools::MeshData teapot = tools::makeTeapot();
  const MeshId mesh = scene.addMesh(teapot.positions, teapot.indices);
  for (double x : {0.0, 8.0, 16.0}) scene.addObject({mesh, {{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}}, ~0u});
  const Transform across{{1, 0, 0, 0.3, 0, 0.8, -0.6, 0.2, 0, 0.6, 0.8, 0.1}};
  const Query whole{.mesh = mesh, .worldFromMesh = across, .direction = {1, 0.1, 0.2}, .distance = 20};
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  CHECK(sweeper.run({&whole, 1})[0].status == Status::overlap);
  const SweepStats all = sweeper.stats();
  const Query decide = deciding({whole})[0];
  const Result result = sweeper.run({&decide, 1})[0];
  CHECK(result.status == Status::hit);
  CHECK(sweeper.stats().pairs < all.pairs / 2);
  CHECK(sweeper.stats().cpuPairs == 0);
}
