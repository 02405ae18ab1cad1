// The CPU's search ends soon after its stop is requested.
#include <thread>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/endless.h"
#include "support/same_bits.h"

using namespace radar;

TEST_CASE("a search on the CPU ends once its stop is requested, and the next one is answered") {
  test::Endless endless;
  const MeshId triangle =
      endless.scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<uint32_t>{0, 1, 2});
  endless.scene.addObject({triangle, test::at(50, 0, 3), ~0u});
  const Query quick{.mesh = triangle, .worldFromMesh = test::at(50, 0, 0), .direction = {0, 0, 1}, .distance = 5};
  std::vector<Query> slow(4, endless.query);
  slow[1].clearance = 1e-9;
  slow[2].skipOverlapping = true;
  slow[3].hits = kAllHits;
  slow[3].direction = {};
  slow[3].motion = {0, 0, 1e-9};
  CpuSweeper sweeper(endless.scene, 2);
  const Result expected = sweeper.run({&quick, 1}).results[0];
  CHECK(expected.t == 3);
  for (const Query& query : slow) {
    std::stop_source stop;
    // The search usually has begun by then; it must end in any case.
    const std::jthread stopping([&] { stop.request_stop(); });
    const std::vector<Query> queries{quick, query, query, quick};
    const Answers answers = sweeper.run(queries, stop.get_token());
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(i);
      if (answers.reasons.contains(i)) {
        CHECK(answers.reasons.at(i) == "cancelled");
        CHECK(answers.results[i].status == Status::invalid);
        CHECK((answers.lists.empty() || answers.lists[i].hits.empty()));
      } else {
        CHECK(test::differenceOf({&answers.results[i], 1}, {&expected, 1}) == "");
      }
    }
    CHECK(answers.reasons.contains(1));
    CHECK(answers.reasons.contains(2));
    CHECK(answers.stats.cpuQueries == queries.size() - answers.reasons.size());
    CHECK(test::differenceOf(sweeper.run({&quick, 1}).results, {&expected, 1}) == "");
  }
}

TEST_CASE("of a batch whose stop has been requested before, the CPU answers nothing") {
  Scene scene;
  const MeshId box = test::add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({box, test::at(0, 0, 3), ~0u});
  CpuSweeper sweeper(scene);
  std::stop_source stop;
  stop.request_stop();
  const std::vector<Query> queries(
      100, {.mesh = box, .worldFromMesh = test::at(0, 0, 0), .direction = {0, 0, 1}, .distance = 5});
  const Answers answers = sweeper.run(queries, stop.get_token());
  CHECK(answers.reasons.size() == queries.size());
  CHECK(answers.stats.pairs == 0);
}
