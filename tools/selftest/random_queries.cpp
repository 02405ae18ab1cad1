#include "selftest/random_queries.h"

#include <algorithm>
#include <cmath>

#include "bench/clock.h"
#include "radar/cpu_sweeper.h"
#include "stability/promises.h"
#include "workloads/families.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kQueriesPerScene = 64;
constexpr const char* kAtDistance = "at-distance";

Workload familyScene(Family family, uint64_t seed) {
  return makeWorkload(FamilyScene{.family = family, .queries = kQueriesPerScene, .seed = seed});
}

void count(RandomTally& tally, const Verdict& verdict, const Result& result, const Result& exact) {
  ++tally.queries;
  tally.hits += exact.status == Status::hit;
  tally.clear += exact.status == Status::clear;
  tally.overlaps += exact.status == Status::overlap;
  tally.missed += verdict.missed;
  tally.falseHits += verdict.falseHit;
  tally.unanswered += verdict.unanswered || result.status == Status::undecided;
  tally.wrongStatus += verdict.wrongStatus;
  tally.wrongPair += verdict.wrongPair;
  tally.brackets += verdict.bracket;
  tally.late += verdict.late;
  tally.points += verdict.point;
  tally.normals += verdict.normal;
  tally.wrong += !verdict.right();
  tally.worstError = std::max(tally.worstError, verdict.error);
}

}  // namespace

std::vector<std::string> randomFamilies(const MeshFamilies& meshes) {
  std::vector<std::string> names;
  for (const Family family : kFamilies) names.push_back(nameOf(family));
  names.push_back(kAtDistance);
  for (const auto& [name, own] : meshes) names.push_back(name);
  return names;
}

void RandomTally::add(const RandomTally& other) {
  for (uint64_t RandomTally::*number :
       {&RandomTally::queries, &RandomTally::hits, &RandomTally::clear, &RandomTally::overlaps, &RandomTally::missed,
        &RandomTally::falseHits, &RandomTally::unanswered, &RandomTally::wrongStatus, &RandomTally::wrongPair,
        &RandomTally::brackets, &RandomTally::late, &RandomTally::points, &RandomTally::normals, &RandomTally::wrong,
        &RandomTally::pairs, &RandomTally::cpuPairs}) {
    this->*number += other.*number;
  }
  worstError = std::max(worstError, other.worstError);
  deviceSeconds += other.deviceSeconds;
  cpuSeconds += other.cpuSeconds;
}

/// One scene whose meshes and objects are exchanged, and what answers it: pipelines are made once.
struct RandomQueries::Stage {
  Stage(const Device& device, MeshFamilies more)
      : meshes(std::move(more)), sweeper(device, scene, {.cpuBatch = 0}), cpu(scene) {}

  Workload sceneOf(const std::string& family, uint64_t seed, uint64_t number) const {
    const uint64_t sceneSeed = seed * 1'000'003 + number;
    if (const auto found = meshes.find(family); found != meshes.end()) {
      return makeWorkload(
          RandomPoses{.meshes = found->second, .objects = 100, .sensors = kQueriesPerScene, .seed = sceneSeed});
    }
    if (family == kAtDistance) return familyScene(kFamilies[number % kFamilies.size()], sceneSeed);
    const auto found = std::find_if(kFamilies.begin(), kFamilies.end(), [&](Family f) { return family == nameOf(f); });
    if (found == kFamilies.end()) throw Error("no family is called " + family);
    return familyScene(*found, sceneSeed);
  }

  void show(const Workload& workload) {
    replaceBy(workload, 0, scene);
    sweeper.sync();
    cpu.sync();
  }

  /// D becomes where the CPU finds the contact, or a rounding beside it.
  void moveDistances(std::vector<Query>& queries, uint64_t number) {
    for (Query& query : queries) {
      const Result exact = cpu.run({&query, 1})[0];
      const uint64_t which = number++ % 3;
      if (exact.status != Status::hit) continue;
      query.distance = which == 0 ? exact.t : std::nextafter(exact.t, which == 1 ? 0 : INFINITY);
    }
  }

  MeshFamilies meshes;
  Scene scene;
  Sweeper sweeper;
  CpuSweeper cpu;
};

RandomQueries::RandomQueries(const Device& device, MeshFamilies meshes)
    : stage_(std::make_unique<Stage>(device, std::move(meshes))) {}
RandomQueries::~RandomQueries() = default;

RandomTally RandomQueries::run(const Range& range, const std::function<void(uint64_t, const std::string&)>& onWrong,
                               const std::function<void(uint64_t)>& onProgress) {
  RandomTally tally;
  uint64_t next = range.first;
  const uint64_t end = range.first + range.queries;
  while (next < end) {
    const uint64_t number = next / kQueriesPerScene;
    const Workload workload = stage_->sceneOf(range.family, range.seed, number);
    std::vector<Query> queries;
    const uint64_t first = next;
    for (; next < std::min(end, (number + 1) * kQueriesPerScene); ++next) {
      queries.push_back(toQuery(workload.queries[next % kQueriesPerScene], Mode::contact));
    }
    stage_->show(workload);
    if (range.family == kAtDistance) stage_->moveDistances(queries, first);
    std::vector<Result> results, exact;
    tally.deviceSeconds += bench::lapOf([&] { results = stage_->sweeper.run(queries); }).wall;
    tally.pairs += stage_->sweeper.stats().pairs;
    tally.cpuPairs += stage_->sweeper.stats().cpuPairs;
    tally.cpuSeconds += bench::lapOf([&] { exact = stage_->cpu.run(queries); }).wall;
    for (size_t i = 0; i < queries.size(); ++i) {
      const Verdict verdict = judgeContact(stage_->scene, queries[i], results[i], exact[i]);
      count(tally, verdict, results[i], exact[i]);
      if (!verdict.right()) onWrong(first + i, verdict.words() + " " + stage_->sweeper.reason(i));
    }
    onProgress(next - range.first);
  }
  return tally;
}

}  // namespace radar::tools
