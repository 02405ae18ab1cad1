// Queries that ask "within D or not" only, and options that change nothing.
#include <cmath>

#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/hard_cases.h"
#include "workloads/query_fields.h"
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

}  // namespace

TEST_CASE("in mode sampled a decision is that of the whole answer") {
  const char* family = GENERATE("convex", "interlocking", "lattice", "touching");
  CAPTURE(family);
  auto [scene, queries] =
      test::caseOf(tools::hardScene(tools::hardFamily(family), 3, 0, 64, tools::Company::mixed), 64);
  Sweeper sweeper(test::device(), scene);
  const std::vector<Result> whole = sweeper.run(queries, Mode::sampled).results;
  queries = deciding(std::move(queries));
  const std::vector<Result> decided = sweeper.run(queries, Mode::sampled).results;
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    CHECK(uint32_t(decided[i].status) == uint32_t(decisionOf(whole[i].status)));
    CHECK((decided[i].status == Status::hit ? decided[i].t == decided[i].hi : !std::isfinite(decided[i].t)));
    CHECK((decided[i].object == kNone && std::isnan(decided[i].point[0])));
    CHECK((decided[i].detected == whole[i].detected && decided[i].resolution == whole[i].resolution));
    if (decided[i].status != Status::hit) continue;
    CHECK(decided[i].lo == 0);
    CHECK(decided[i].hi >= whole[i].hi);
    CHECK(decided[i].hi <= queries[i].distance);
  }
}

TEST_CASE("in mode sampled, options that are said to change nothing change no bit, and are not refused") {
  tools::Workload workload = tools::hardScene(tools::hardFamily("touching"), 3, 0, 64, tools::Company::mixed);
  Scene scene;
  tools::replaceBy(workload, 0, scene);
  Sweeper sweeper(test::device(), scene);
  const auto answers = [&] { return sweeper.run(tools::queriesOf(workload.queries, 64), Mode::sampled); };
  const Answers before = answers();
  size_t idle = 0;
  for (const tools::QueryField& field : tools::queryFields()) {
    if (field.sampled != tools::QueryField::Sampled::idle) continue;
    ++idle;
    for (tools::QuerySpec& query : workload.queries) {
      REQUIRE(tools::setValue(query, field, tools::sensorSize(scene, query) / 16));
      CHECK(tools::exactOnly(query) == nullptr);
    }
    CAPTURE(field.name);
    CHECK(test::differenceOf(answers(), before) == "");
  }
  CHECK(idle == 2);
}

TEST_CASE("a decision on a deep overlap costs a fraction of the whole answer") {
  Scene scene;
  const tools::MeshData teapot = tools::makeTeapot();
  const MeshId mesh = scene.addMesh(teapot.positions, teapot.indices);
  for (double x : {0.0, 8.0, 16.0}) scene.addObject({mesh, {{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}}, ~0u});
  const Transform across{{1, 0, 0, 0.3, 0, 0.8, -0.6, 0.2, 0, 0.6, 0.8, 0.1}};
  const Query whole{.mesh = mesh, .worldFromMesh = across, .direction = {1, 0.1, 0.2}, .distance = 20};
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  const Answers all = sweeper.run({&whole, 1});
  CHECK(all.results[0].status == Status::overlap);
  const Query decide = deciding({whole})[0];
  const Answers decided = sweeper.run({&decide, 1});
  CHECK(decided.results[0].status == Status::hit);
  CHECK(decided.stats.pairs < all.stats.pairs / 2);
  CHECK(decided.stats.cpuPairs == 0);
}
