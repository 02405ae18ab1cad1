#include <catch2/catch.hpp>
#include <cmath>

#include "agreement/compare.h"
#include "reference/reference.h"
#include "stability/promises.h"
#include "support/test_device.h"
#include "workloads/workload.h"

namespace radar::test {

namespace {

void check(const Scene& scene, const Query& query, const Result& result, const Result& exact, BoundedTally& tally) {
  ++tally.queries;
  tally.contacts += exact.status == Status::hit || exact.status == Status::overlap;
  tally.clear += result.status == Status::clear;
  tally.undecided += result.status == Status::undecided;
  CHECK(tools::judgeBracket(query, result, exact).words() == "");
  CHECK((result.tier == Tier::bounded || (result.tier == Tier::select && result.status == Status::clear)));
  const bool found = result.status == Status::hit || result.status == Status::overlap;
  CHECK(found == (result.object != kNone));
  CHECK(found == !std::isnan(result.hi));
  if (!found) return;
  ++tally.found;
  tally.widthInPixels.push_back((result.hi - result.lo) * result.resolution / tools::sensorSize(scene, query));
}

void compare(const Scene& scene, Sweeper& sweeper, reference::Reference& reference, std::vector<Query> queries,
             uint32_t resolution, const std::vector<std::string>& names, BoundedTally& tally) {
  for (Query& query : queries) {
    query.mode = Mode::bounded;
    query.resolution = resolution;
  }
  const std::vector<Result> results = sweeper.run(queries);
  const std::vector<Result> exact = reference.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    INFO("query " << names[i] << " at " << resolution << ": lo " << results[i].lo << " hi " << results[i].hi
                  << ", reference t " << exact[i].t << " of " << queries[i].distance);
    check(scene, queries[i], results[i], exact[i], tally);
  }
}

}  // namespace

void BoundedTally::add(const BoundedTally& more) {
  queries += more.queries;
  contacts += more.contacts;
  found += more.found;
  clear += more.clear;
  undecided += more.undecided;
  widthInPixels.insert(widthInPixels.end(), more.widthInPixels.begin(), more.widthInPixels.end());
}

BoundedTally compareBounded(const Scene& scene, Sweeper& sweeper, reference::Reference& reference,
                            std::vector<Query> queries, uint32_t resolution) {
  BoundedTally tally;
  std::vector<std::string> names;
  for (size_t i = 0; i < queries.size(); ++i) names.push_back(std::to_string(i));
  compare(scene, sweeper, reference, std::move(queries), resolution, names, tally);
  return tally;
}

BoundedTally compareBounded(const Scene& scene, std::vector<Query> queries, uint32_t resolution) {
  Sweeper sweeper(device(), scene);
  reference::Reference reference(scene);
  return compareBounded(scene, sweeper, reference, std::move(queries), resolution);
}

BoundedTally compareBounded(const tools::Workload& workload, uint32_t resolution) {
  BoundedTally tally;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device(), player.scene());
  reference::Reference reference(player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    std::vector<std::string> names;
    for (uint32_t i : batch.queries) {
      queries.push_back(tools::toQuery(workload.queries[i], Mode::bounded));
      names.push_back(workload.queries[i].id);
    }
    compare(player.scene(), sweeper, reference, std::move(queries), resolution, names, tally);
  }
  return tally;
}

}  // namespace radar::test
