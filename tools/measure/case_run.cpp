#include "measure/case_run.h"

#include <algorithm>
#include <cmath>

#include "measure/timing.h"
#include "radar/cpu_sweeper.h"
#include "workloads/generate.h"
#include "workloads/same_answer.h"

namespace radar::tools {

namespace {

constexpr uint32_t kMixedCases = 64;
constexpr const char* kAtDistance = "at-distance";

/// One of so many scenes is asked at that resolution: from 256 on fewer, as pixels grow more.
uint32_t strideOf(uint32_t resolution) {
  return std::max(1u, (resolution / 128) * (resolution / 128));
}

/// The paper's own reading of an answer in mode sampled: contact after min(L) if that is within D, now if it is
/// negative. It vouches for no bounds.
Result paperAnswer(const Query& query, const Result& sampled) {
  Result paper = sampled;
  const bool hit = sampled.paperMinL <= query.distance;
  paper.status = hit ? Status::hit : Status::clear;
  paper.t = hit ? std::max(sampled.paperMinL, 0.0) : NAN;
  paper.lo = paper.hi = NAN;
  return paper;
}

Verdict judgeAs(const Approach& asked, const Scene& scene, const Query& query, const Result& result,
                const Result& exact) {
  if (!asked.paper) return judge(scene, query, asked.mode(), result, exact);
  return judge(paperAnswer(query, result), exact, unitOf(scene, query, exact));
}

}  // namespace

bool offersSampled(const HardFamily& family) {
  return !family.ignoresLeaving && !family.skipsOverlapping;
}

/// Whether two batches' answers list the same for a query.
bool sameLists(const Answers& ours, const Answers& exact, size_t query) {
  if (ours.lists.empty() || exact.lists.empty()) return ours.lists.size() == exact.lists.size();
  const Listed &own = ours.lists[query], &right = exact.lists[query];
  return own.overlapping == right.overlapping && std::ranges::equal(own.hits, right.hits, sameAnswer);
}

std::vector<std::string> runFamilies(const MeshFamilies& meshes) {
  std::vector<std::string> names = hardFamilyNames();
  names.push_back(kAtDistance);
  for (const auto& [name, own] : meshes) names.push_back(name);
  return names;
}

/// One scene whose meshes and objects are exchanged, and what answers it: pipelines are made once.
struct CaseRun::Stage {
  Stage(const Device& device, MeshFamilies more)
      : meshes(std::move(more)), sweeper(device, scene, {.cpuBatch = 0}), cpu(scene) {}

  Workload sceneOf(const CaseRange& range, uint64_t number, uint32_t size) const {
    if (const auto found = meshes.find(range.family); found != meshes.end()) {
      return makeWorkload(RandomPoses{
          .meshes = found->second, .objects = 100, .sensors = size, .seed = range.seed * 1'000'003 + number});
    }
    const bool atDistance = range.family == kAtDistance;
    const HardFamily& family = atDistance ? hardFamilies()[number % hardFamilies().size()] : hardFamily(range.family);
    return hardScene(family, range.seed, number * size, size, range.company);
  }

  /// D becomes where the CPU finds the contact, or a rounding beside it.
  void moveDistances(std::vector<Query>& queries, uint64_t number) {
    const std::vector<Result> exact = cpu.run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i, ++number) {
      if (exact[i].status != Status::hit) continue;
      const double beside = number % 3 == 1 ? 0 : INFINITY;
      queries[i].distance = number % 3 == 0 ? exact[i].t : std::nextafter(exact[i].t, beside);
    }
  }

  /// Most objects move, by up to as much as some sensor; a third of the queries keep their direction. `workload`: the
  /// scene's, so that a query is the same in any range that has it.
  void setMotions(const CaseRange& range, uint64_t number, const Workload& workload, std::vector<Query>& queries) {
    Random random(range.seed * 1'000'033 + number / workload.queries.size());
    tools::setMotions(workload, random, scene);
    for (Query& query : queries) {
      if (number++ % 3 != 0 && range.family != kAtDistance) takeStep(query);
    }
  }

  void setClearances(const CaseRange& range, uint64_t number, std::vector<Query>& queries) const {
    for (Query& query : queries) {
      Random random(range.seed * 1'000'003 + number++);
      query.clearance = random.magnitude(-8, 1) * sensorSize(scene, query);
      if (random.oneIn(3)) query.tolerance = random.magnitude(-12, 0) * query.clearance;
    }
  }

  /// The cases of the range from number `next` on that are in one scene with it.
  std::vector<Query> show(const CaseRange& range, uint64_t next, uint32_t size) {
    const Workload workload = sceneOf(range, next / size, size);
    replaceBy(workload, 0, scene);
    sweeper.sync();
    cpu.sync();
    const uint64_t end = std::min(range.first + range.cases, (next / size + 1) * size);
    std::vector<Query> queries;
    for (uint64_t i = next; i < end; ++i) queries.push_back(workload.queries[i % size]);
    for (Query& query : queries) {
      if (range.ignoreLeaving) query.ignoreLeaving = true;
      if (range.allHits) query.hits = kAllHits;
    }
    if (range.clearances) setClearances(range, next, queries);
    if (range.steps) setMotions(range, next, workload, queries);
    if (range.family == kAtDistance) moveDistances(queries, next);
    return queries;
  }

  MeshFamilies meshes;
  Scene scene;
  Sweeper sweeper;
  CpuSweeper cpu;
};

CaseRun::CaseRun(const Device& device, MeshFamilies meshes)
    : stage_(std::make_unique<Stage>(device, std::move(meshes))) {}
CaseRun::~CaseRun() = default;

std::vector<Tally> CaseRun::run(const CaseRange& range, std::span<const Approach> asked, const OnWrong& onWrong,
                                const std::function<void(uint64_t)>& onProgress) {
  std::vector<Tally> tallies(asked.size());
  const uint32_t size = range.company == Company::mixed ? kMixedCases : kIsolatedCases;
  for (uint64_t next = range.first; next < range.first + range.cases;) {
    std::vector<Query> queries = stage_->show(range, next, size);
    Answers exact, found;
    const double cpuSeconds = lapOf([&] { exact = stage_->cpu.run(queries); }).wall;
    double seconds = 0;
    for (size_t a = 0; a < asked.size(); ++a) {
      if (next / size % strideOf(asked[a].resolution) != 0) continue;
      for (Query& query : queries) query.resolution = asked[a].resolution;
      // The paper's min(L) stands beside mode sampled's own answer.
      if (a == 0 || asked[a].resolution != asked[a - 1].resolution) {
        seconds = lapOf([&] { found = stage_->sweeper.run(queries, asked[a].mode()); }).wall;
      }
      Tally& tally = tallies[a];
      tally.deviceSeconds += seconds;
      tally.cpuSeconds += cpuSeconds;
      tally.pairs += found.stats.pairs;
      tally.cpuPairs += found.stats.cpuPairs;
      for (size_t i = 0; i < queries.size(); ++i) {
        const Result &result = found.results[i], &right = exact.results[i];
        Verdict verdict = judgeAs(asked[a], stage_->scene, queries[i], result, right);
        verdict.set(Fault::wrongList, !sameLists(found, exact, i));
        tally.add(verdict, right);
        if (asked[a].paper || verdict.right()) continue;
        const auto reason = found.reasons.find(i);
        onWrong(next + i, asked[a], verdict.words() + " " + (reason == found.reasons.end() ? "" : reason->second));
      }
    }
    next += queries.size();
    onProgress(queries.size());
  }
  return tallies;
}

Tally CaseRun::run(const CaseRange& range, const OnWrong& onWrong, const std::function<void(uint64_t)>& onProgress) {
  const Approach contact;
  return run(range, {&contact, 1}, onWrong, onProgress)[0];
}

}  // namespace radar::tools
