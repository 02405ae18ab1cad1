// Compares the exact answers to hard cases with brute force in exact integers, which uses another method than the
// engine.
#include "soups.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr uint64_t kMostPairs = 1000;  // brute force is slow

Workload workloadOf(const HardCase& hard) {
  return sceneOf({hard}, Company::isolated);
}

uint64_t pairsOf(const HardCase& hard) {
  uint64_t pairs = 0;
  for (const PlacedMesh& object : hard.objects) pairs += object.mesh.triangleCount();
  return pairs * hard.sensor.mesh.triangleCount();
}

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

TEST_CASE("the CPU's answers equal brute force for hard cases") {
  uint32_t families = 0;
  for (const HardFamily& family : hardFamilies()) {
    uint32_t checked = 0;
    for (uint64_t number = 0; number < 96 && checked < 20; ++number) {
      const HardCase hard = hardCase(family, 23, number);
      if (pairsOf(hard) > kMostPairs) continue;
      INFO(family.name << ", case " << number);
      const Workload workload = workloadOf(hard);
      Scene scene;
      replaceBy(workload, 0, scene);
      const Query query = workload.queries[0];
      soups::check(scene, query, test::answer(scene, query));
      ++checked;
    }
    families += checked >= 6;
  }
  // Rings, cups and the teapot have too many triangles.
  CHECK(families >= 20);
}

TEST_CASE("all contacts and skipped objects among bodies at rest equal brute force") {
  size_t cases = 0, contacts = 0, skipped = 0;
  for (const HardFamily& family : hardFamilies()) {
    if (!family.ignoresLeaving) continue;
    for (uint64_t number = 0; number < 300; ++number) {
      const HardCase hard = hardCase(family, 29, number);
      if (pairsOf(hard) > kMostPairs) continue;
      INFO(family.name << ", case " << number);
      const Workload workload = workloadOf(hard);
      Scene scene;
      replaceBy(workload, 0, scene);
      Query query = workload.queries[0];
      query.hits = kAllHits;
      const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
      ++cases;
      const auto& [hits, overlapping] = answers.lists[0];
      const oracle::Truth truth = oracle::truthOf(scene, query);
      const std::string fault = oracle::faultOf(truth, query, answers.results[0], hits, overlapping);
      INFO(fault);
      REQUIRE(fault.empty());
      contacts += truth.contacts.size();
      skipped += truth.overlapping.size();
    }
  }
  CHECK(cases > 700);
  CHECK(contacts > 500);
  CHECK(skipped > 20);
}

TEST_CASE("bodies at rest are wound outwards, and the one that moves later touches others without crossing them") {
  size_t touching = 0;
  for (const HardFamily& family : hardFamilies()) {
    if (!family.ignoresLeaving || family.skipsOverlapping) continue;
    for (uint64_t number = 0; number < 200; ++number) {
      INFO(family.name << ", case " << number);
      const HardCase hard = hardCase(family, 31, number);
      const Workload workload = workloadOf(hard);
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
