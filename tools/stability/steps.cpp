#include "stability/measure.h"

#include <algorithm>
#include <cmath>

#include "radar/cpu_sweeper.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

namespace {

/// The query again and again, its sensor a step further each time.
void appendSteps(std::vector<Query>& queries, const Query& first, const Vec3& step, uint32_t count) {
  for (uint32_t i = 0; i <= count; ++i) {
    Query query = first;
    for (size_t k = 0; k < 3; ++k) query.worldFromMesh.m[4 * k + 3] += i * step[k];
    queries.push_back(std::move(query));
  }
}

void count(StepRow& row, const Result& before, const Result& after, const Result& exactBefore, const Result& exactAfter,
           double size) {
  if (!meets(exactBefore) || !meets(exactAfter)) return;
  ++row.steps;
  row.flips += meets(before) != meets(after);
  if (!meets(before) || !meets(after)) return;
  const double own = std::abs(after.t - before.t), due = std::abs(exactAfter.t - exactBefore.t);
  row.excess = std::max(row.excess, (own - due) / std::max(size, exactAfter.t));
}

}  // namespace

std::vector<StepRow> measureSteps(const Device& device, const StepSettings& settings,
                                  const std::function<void(uint64_t)>& onProgress) {
  Scene scene;
  Sweeper sweeper(device, scene, {.cpuBatch = 0});
  CpuSweeper cpu(scene);
  std::vector<StepRow> rows;
  for (const HardFamily& family : hardFamilies()) {
    std::vector<StepRow> own;
    if (offersSampled(family)) {
      own.push_back({family.name, {settings.resolution, true}});
      own.push_back({family.name, {settings.resolution}});
    }
    own.push_back({family.name});
    for (uint32_t next = 0; next < settings.cases; next += kIsolatedCases) {
      const uint32_t cases = std::min(settings.cases - next, kIsolatedCases);
      const Workload workload = hardScene(family, settings.seed, next, cases, Company::isolated);
      replaceBy(workload, 0, scene);
      Random random(settings.seed * 7'919 + next);
      std::vector<Query> queries;
      for (const Query& query : workload.queries) {
        const Vec3 step = settings.size * sensorSize(scene, query) * random.direction();
        appendSteps(queries, query, step, settings.steps);
      }
      const std::vector<Result> exact = cpu.run(queries).results;
      for (StepRow& row : own) {
        const std::vector<Result> results = answersBy(row.asked, sweeper, queries);
        for (size_t i = 1; i < queries.size(); ++i) {
          if (i % (settings.steps + 1) == 0) continue;
          count(row, results[i - 1], results[i], exact[i - 1], exact[i], sensorSize(scene, queries[i]));
        }
      }
      onProgress(cases);
    }
    rows.insert(rows.end(), own.begin(), own.end());
  }
  return rows;
}

}  // namespace radar::tools
