#include "agreement/compare.h"

#include <algorithm>
#include <cmath>

#include "support/answer.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace radar::test {

namespace {

/// First contact of the two triangles of an answer alone: NaN where there is none.
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

/// What mode sampled promises of the pair that it names.
void checkPair(const Scene& scene, const Query& query, const Result& result, const Result& exact) {
  const double size = tools::sensorSize(scene, query);
  // The exact t is rounded; `hi` adds its error bound to its own rounding.
  const double rounding = 0x1p-50 * (exact.t + size);
  CHECK(result.hi >= exact.t - rounding);
  const double own = pairContact(scene, query, result);
  CHECK(result.hi <= own + 1e-6 * std::max(size, own));
  CHECK(result.hi >= own - rounding);
}

void compareBatch(const Scene& scene, Sweeper& sweeper, CpuSweeper& cpu, const std::vector<Query>& queries, Mode mode,
                  Compared& compared) {
  std::vector<Query> whole = queries;
  for (Query& query : whole) query.anyHit = query.anyHit && mode != Mode::sampled;
  const std::vector<Result> results = sweeper.run(queries, mode).results, exact = cpu.run(whole).results;
  REQUIRE(results.size() == queries.size());
  for (size_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    const Result& result = results[i];
    CAPTURE(i, query.distance, query.anyHit, query.resolution, exact[i].t, exact[i].object, exact[i].triB,
            exact[i].triA);
    const tools::Verdict verdict = tools::judge(scene, query, mode, result, exact[i]);
    compared.tally.add(verdict, exact[i]);
    INFO(verdict.words());
    CHECK(verdict.right());
    const bool sampled = mode == Mode::sampled;
    const bool selected = result.tier == Tier::select && result.status == Status::clear;
    CHECK((selected || result.tier == (sampled ? Tier::sampled : Tier::contact)));
    if (!sampled || !verdict.found || query.anyHit) continue;
    checkPair(scene, query, result, exact[i]);
    if (result.resolution == 0) continue;
    compared.excessInPixels.push_back((result.hi - exact[i].t) * result.resolution / tools::sensorSize(scene, query));
  }
}

}  // namespace

Compared compare(const Scene& scene, const std::vector<Query>& queries, Mode mode) {
  Sweeper sweeper(device(), scene, {.cpuBatch = 0});
  CpuSweeper cpu(scene);
  Compared compared;
  compareBatch(scene, sweeper, cpu, queries, mode, compared);
  return compared;
}

Compared compare(const tools::Workload& workload, uint32_t resolution) {
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device(), player.scene(), {.cpuBatch = 0});
  CpuSweeper cpu(player.scene());
  Compared compared;
  for (const tools::Batch& batch : tools::batchesOf(workload.queries, resolution)) {
    player.show(batch.scene);
    compareBatch(player.scene(), sweeper, cpu, batch.queries, resolution == 0 ? Mode::contact : Mode::sampled,
                 compared);
  }
  return compared;
}

}  // namespace radar::test
