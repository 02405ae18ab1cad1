#include <catch2/catch.hpp>

#include "agreement/compare.h"
#include "stability/promises.h"
#include "support/answer.h"
#include "support/test_device.h"

namespace radar::test {

namespace {

void compare(const Scene& scene, Sweeper& sweeper, CpuSweeper& cpu, std::vector<Query> queries,
             const std::vector<std::string>& names, ContactTally& tally) {
  for (Query& query : queries) query.mode = Mode::contact;
  const std::vector<Result> results = sweeper.run(queries);
  const std::vector<Result> exact = cpu.run(queries);
  REQUIRE(results.size() == queries.size());
  for (size_t i = 0; i < queries.size(); ++i) {
    ++tally.queries;
    tally.hits += exact[i].status == Status::hit;
    tally.overlaps += exact[i].status == Status::overlap;
    tally.clear += exact[i].status == Status::clear;
    INFO("query " << names[i] << ", exact t " << exact[i].t << " of " << queries[i].distance << " object "
                  << exact[i].object << " triB " << exact[i].triB << " triA " << exact[i].triA);
    const tools::Verdict verdict = tools::judgeContact(scene, queries[i], results[i], exact[i]);
    CHECK(verdict.words() == "");
    CHECK(verdict.error <= 1e-12);
    CHECK(
        (results[i].tier == Tier::contact || (results[i].tier == Tier::select && results[i].status == Status::clear)));
  }
}

}  // namespace

ContactTally compareContact(const Scene& scene, std::vector<Query> queries) {
  ContactTally tally;
  Sweeper sweeper(device(), scene, {.cpuBatch = 0});
  CpuSweeper cpu(scene);
  std::vector<std::string> names;
  for (size_t i = 0; i < queries.size(); ++i) names.push_back(std::to_string(i));
  compare(scene, sweeper, cpu, std::move(queries), names, tally);
  return tally;
}

ContactTally compareContact(const tools::Workload& workload) {
  ContactTally tally;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device(), player.scene(), {.cpuBatch = 0});
  CpuSweeper cpu(player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    std::vector<std::string> names;
    for (uint32_t i : batch.queries) {
      queries.push_back(tools::toQuery(workload.queries[i], Mode::contact));
      names.push_back(workload.queries[i].id);
    }
    compare(player.scene(), sweeper, cpu, std::move(queries), names, tally);
  }
  return tally;
}

}  // namespace radar::test
