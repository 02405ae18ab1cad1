#include "agreement/compare.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "stability/promises.h"
#include "support/answer.h"
#include "support/test_device.h"
#include "workloads/workload.h"

namespace radar::test {

namespace {

// First contact of one triangle pair alone: NaN where there is none.
double pairContact(const Scene& scene, const Query& query, const Result& result) {
  const auto triangleOf = [&](MeshId mesh, uint32_t triangle) {
    const MeshView view = scene.mesh(mesh);
    std::vector<float> corners;
    for (uint32_t i = 0; i < 3; ++i) {
      const float* p = &view.positions[3 * size_t{view.indices[3 * size_t{triangle} + i]}];
      corners.insert(corners.end(), p, p + 3);
    }
    return corners;
  };
  const std::vector<uint32_t> indices{0, 1, 2};
  Scene pair;
  const Object& object = scene.object(result.object);
  const MeshId b = pair.addMesh(triangleOf(object.mesh, result.triB), indices);
  Query alone = query;
  alone.mesh = pair.addMesh(triangleOf(query.mesh, result.triA), indices);
  alone.exclude.clear();
  alone.mask = ~0u;
  pair.addObject({b, object.worldFromMesh, ~0u});
  return test::answer(pair, alone).t;
}

// Every promise that a single sampled answer makes.
void checkAnswer(const Scene& scene, const Query& query, const Result& sampled, const Result& exact, Tally& tally) {
  ++tally.queries;
  const bool contact = exact.status == Status::hit || exact.status == Status::overlap;
  tally.contacts += contact;
  CHECK(sampled.status != Status::invalid);
  if (sampled.status == Status::clear) {
    ++tally.clear;
    CHECK_FALSE(contact);
    CHECK(sampled.tier == Tier::select);
    CHECK(sampled.detected == Detected::no);
    return;
  }
  CHECK(sampled.tier == Tier::sampled);
  CHECK(sampled.lo == 0);
  if (sampled.status == Status::undecided) {
    CHECK(std::isnan(sampled.hi));
    CHECK(sampled.object == kNone);
    return;
  }
  ++tally.found;
  REQUIRE(contact);
  CHECK(sampled.hi <= query.distance);
  CHECK(sampled.t == sampled.hi);
  // The exact t is rounded; `hi` adds its error bound to its own rounding.
  const double rounding = 0x1p-50 * (exact.t + tools::sensorSize(scene, query));
  CHECK(sampled.hi >= exact.t - rounding);
  if (sampled.status == Status::overlap) CHECK(exact.status == Status::overlap);
  const double own = pairContact(scene, query, sampled);
  CHECK(sampled.hi <= own + 1e-6 * std::max(tools::sensorSize(scene, query), own));
  CHECK(sampled.hi >= own - rounding);
  if (sampled.resolution != 0) {
    tally.excessInPixels.push_back((sampled.hi - exact.t) * sampled.resolution / tools::sensorSize(scene, query));
  }
}

}  // namespace

Tally compareWithReference(const tools::Workload& workload, uint32_t resolution) {
  Tally tally;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device(), player.scene());
  CpuSweeper exact(player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    for (uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], Mode::sampled, resolution));
    const std::vector<Result> sampled = sweeper.run(queries);
    const std::vector<Result> truth = exact.run(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      INFO("query " << workload.queries[batch.queries[i]].id << " at " << resolution);
      checkAnswer(player.scene(), queries[i], sampled[i], truth[i], tally);
    }
  }
  return tally;
}

}  // namespace radar::test
