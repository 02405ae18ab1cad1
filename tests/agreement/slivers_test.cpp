// Queries with a clearance through slivers: the device's answers have the CPU's bits, and none is left undecided.
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "unit/soups.h"

using namespace radar;
using soups::Random;

namespace {

/// Soups of which poses stretch one axis.
struct Slivers {
  Scene scene;
  std::vector<Query> queries;

  Slivers(uint64_t seed, double stretch) {
    Random random(seed);
    const auto near = [&](double spread) {
      auto p = random.inBall();
      for (double& c : p) c *= spread;
      return p;
    };
    const auto pose = [&](double scale) {
      Transform placed = random.pose(scale, near(4));
      const auto axis = static_cast<size_t>(random.integer(0, 2));
      for (size_t i = 0; i < 3 && seed % 4 != 0; ++i) placed.m[4 * i + axis] *= stretch;
      return placed;
    };
    const auto mesh = [&] {
      return soups::add(scene, soups::soup(random, random.integer(1, 6), random.uniform(0.05, 0.7), 0.2));
    };
    const MeshId sensor = mesh(), other = mesh();
    for (int i = random.integer(1, 3); i-- > 0;) scene.addObject({other, pose(random.uniform(0.3, 2))});
    for (int i = 0; i < 4; ++i) {
      Query query{.mesh = sensor, .worldFromMesh = pose(random.uniform(0.3, 1)), .direction = near(1)};
      for (size_t k = 0; k < 3; ++k) {
        query.direction[k] += scene.object(0).worldFromMesh.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
      }
      query.distance = random.uniform(0, 12) * (random.chance(0.5) ? stretch : 1);
      query.clearance = std::exp(random.uniform(-7, 1)) * (random.chance(0.3) ? stretch : 1);
      if (random.chance(0.3)) query.tolerance = random.chance(0.3) ? 0 : std::exp(random.uniform(-20, -3));
      queries.push_back(query);
    }
  }
};

}  // namespace

TEST_CASE("with a clearance, slivers have the CPU's bits on the device, and are decided") {
  for (const double stretch : {1.0, 1e5, 1e7, 1e9, 1e11}) {
    size_t hits = 0, others = 0, undecided = 0;
    for (uint64_t seed = 0; seed < 120; ++seed) {
      const Slivers slivers(seed, stretch);
      Sweeper onDevice(test::device(), slivers.scene, {.cpuBatch = 0}),
          onCpu(test::device(), slivers.scene, {.cpuBatch = 1000});
      const std::vector<Result> device = onDevice.run(slivers.queries).results,
                                cpu = onCpu.run(slivers.queries).results;
      for (size_t i = 0; i < cpu.size(); ++i) {
        CAPTURE(stretch, seed, i, cpu[i].lo, cpu[i].hi, device[i].lo, device[i].hi);
        CHECK(test::sameBits(device[i], cpu[i]));
        hits += cpu[i].status == Status::hit;
        others += cpu[i].status == Status::clear || cpu[i].status == Status::overlap;
        undecided += cpu[i].status == Status::undecided;
      }
    }
    CAPTURE(stretch);
    CHECK(hits > 20);
    CHECK(others > 100);
    CHECK(undecided == 0);
  }
}
