// Compares the truth of tests/stability with brute force in exact integers, which uses another method than the engine.
#include "soups.h"
#include "workloads/stability.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr uint64_t kMostPairs = 1000;  // brute force is slow

uint64_t pairsOf(const StabilityCase& made) {
  uint64_t pairs = 0;
  for (const PlacedMesh& object : made.objects) pairs += object.mesh.triangleCount();
  return pairs * made.sensor.mesh.triangleCount();
}

}  // namespace

TEST_CASE("the CPU's answers equal brute force in the stability families") {
  uint32_t families = 0;
  for (const StabilityFamily& family : stabilityFamilies()) {
    uint32_t checked = 0;
    for (uint64_t number = 0; number < 96 && checked < 20; ++number) {
      const StabilityCase made = stabilityCase(family, number, 23);
      if (pairsOf(made) > kMostPairs) continue;
      INFO(family.name << ", case " << number);
      const Workload workload = workloadOf({made});
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
