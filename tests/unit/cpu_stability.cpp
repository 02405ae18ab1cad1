// Compares the exact answers to hard cases with brute force in exact integers, which uses another method than the
// engine.
#include "soups.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr uint64_t kMostPairs = 1000;  // brute force is slow

uint64_t pairsOf(const HardCase& hard) {
  uint64_t pairs = 0;
  for (const PlacedMesh& object : hard.objects) pairs += object.mesh.triangleCount();
  return pairs * hard.sensor.mesh.triangleCount();
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
      const Workload workload = sceneOf({hard}, Company::isolated);
      Scene scene;
      replaceBy(workload, 0, scene);
      const Query query = toQuery(workload.queries[0], Mode::contact);
      soups::check(scene, query, test::answer(scene, query));
      ++checked;
    }
    families += checked >= 6;
  }
  // Rings, cups and the teapot have too many triangles.
  CHECK(families >= 20);
}
