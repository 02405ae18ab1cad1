// Hard cases of bodies at rest are what they say.
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

namespace {

/// Positive if a closed mesh is wound outwards.
double volumeOf(const MeshView& mesh) {
  double sum = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::array<Vec3, 3> p;
    for (size_t k = 0; k < 3; ++k) {
      const float* corner = &mesh.positions[3 * size_t{mesh.indices[i + k]}];
      p[k] = {corner[0], corner[1], corner[2]};
    }
    for (size_t k = 0; k < 3; ++k) {
      const size_t x = (k + 1) % 3, y = (k + 2) % 3;
      sum += p[0][k] * (p[1][x] * p[2][y] - p[1][y] * p[2][x]);
    }
  }
  return sum / 6;
}

}  // namespace

TEST_CASE("bodies at rest are wound outwards, and the one that moves later touches others without crossing them") {
  size_t touching = 0;
  for (const HardFamily& family : hardFamilies()) {
    if (!family.ignoresLeaving || family.skipsOverlapping) continue;
    for (uint64_t number = 0; number < 200; ++number) {
      INFO(family.name << ", case " << number);
      const HardCase hard = hardCase(family, 31, number);
      const Workload workload = sceneOf({hard}, Company::isolated);
      Scene scene;
      replaceBy(workload, 0, scene);
      for (const MeshData& mesh : workload.meshes) CHECK(volumeOf({mesh.positions, mesh.indices}) > 0);
      if (hard.exclude.empty()) continue;
      const Object& atRest = scene.object(hard.exclude[0]);
      Query query{.mesh = atRest.mesh,
                  .worldFromMesh = atRest.worldFromMesh,
                  .direction = hard.direction,
                  .exclude = hard.exclude,
                  .skipOverlapping = true};
      const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
      touching += answers.results[0].status == Status::overlap;
      CHECK(answers.lists[0].overlapping.empty());
    }
  }
  CHECK(touching > 250);
}
