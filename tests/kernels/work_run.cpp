// What the lanes of the search do on a device, per query, by command: where its time goes.
#include <cstdio>
#include <exception>

#include "commit/commit.h"
#include "contact/submitter.h"
#include "support/world.h"
#include "workloads/drop_cutter.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace {

using namespace radar;

void printWork(const Device& device, const char* name, const tools::Workload& workload) {
  const test::Case asked = test::caseOf(workload);
  const Scene::Impl& scene = asked.scene.impl();
  GpuScene copy(device.impl());
  SearchPlan batch;
  for (uint32_t i = 0; i < asked.queries.size(); ++i) {
    if (batch.add(asked.queries[i], i, scene, scene.objectTree()) != Planned::added) throw Error("out of range");
  }
  ContactSubmitter submitter(device.impl(), copy, false, {.countsWork = true});
  std::vector<StageTime> stages;
  submitter.submit(batch.source(), scene);
  submitter.collect(stages, {});
  const gpu::SearchCounts& counts = submitter.counts();
  const double queries = batch.count();
  std::printf("| %s | %.0f |", name, queries);
  for (uint32_t what = 0; what < gpu::kWorks; ++what) {
    std::printf(" %.1f (%.0f%%) |", counts.done[what] / queries, 100.0 * counts.done[what] / counts.steps[what]);
  }
  std::printf(" %.1f |\n", counts.refinedPairs / queries);
  std::fflush(stdout);
}

}  // namespace

int main() try {
  using namespace radar::tools;
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s; per query, and the share of lanes that had something to do\n\n",
              device.name().c_str(), device.driver().c_str(), commit());
  std::printf(
      "| workload | queries | nodes over objects | objects | pairs of nodes | pairs of leaves | solved in float "
      "| refined |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  constexpr uint32_t kSensors = 4096;
  printWork(device, "teapots among 10,000 boxes", makeWorkload(Table1{.sensors = kSensors}));
  printWork(device, "boxes among 10,000 boxes", makeWorkload(Table1{.sensors = kSensors, .shape = SensorShape::box}));
  printWork(device, "boxes among 1,000,000 boxes",
            makeWorkload(Scale{.boxes = 1'000'000, .sensors = kSensors, .shape = SensorShape::box}));
  printWork(device, "teapots over a mesh of 1,000,000 triangles", makeWorkload(OneMesh{.sensors = kSensors}));
  printWork(device, "ball cutter over a relief", makeWorkload(DropCutter{.columns = 64, .rows = 64}));
  printWork(device, "soups of triangles", makeWorkload(Soups{.sensors = kSensors}));
  printWork(device, "crossing gratings, interlocked",
            makeWorkload(InterlockingPairs{.kind = Interlocking::crossing, .sensors = 256}));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_kernel_work: %s\n", error.what());
  return 2;
}
