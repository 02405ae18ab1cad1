// Compares the CPU's search with brute force over all pairs in exact arithmetic.
#include "cpu_agreement.h"

using namespace radar;
using soups::Random;

namespace {

/// Checks queries through a scene of soups of about the size `scale`, up to `far` from the origin.
void runSoup(uint64_t seed, double scale, double far) {
  Random random(seed);
  Scene scene;
  const std::array<double, 3> centre{far * random.uniform(-1, 1), far * random.uniform(-1, 1), far};
  const auto near = [&](double spread) {
    auto p = random.inBall();
    for (size_t k = 0; k < 3; ++k) p[k] = centre[k] + scale * spread * p[k];
    return p;
  };
  std::vector<MeshId> meshes;
  for (int m = 0; m < 3; ++m) {
    meshes.push_back(add(scene, soups::soup(random, random.integer(1, 14), random.uniform(0.05, 0.7), 0.2)));
  }
  const auto anyMesh = [&] { return meshes[static_cast<size_t>(random.integer(0, 2))]; };
  for (int i = random.integer(1, 5); i-- > 0;) {
    scene.addObject({anyMesh(), random.pose(scale * random.uniform(0.3, 2), near(4)), random.chance(0.2) ? 1u : ~0u});
  }
  std::vector<Query> queries(4);
  for (Query& query : queries) {
    query.mesh = anyMesh();
    query.worldFromMesh = random.pose(scale * random.uniform(0.3, 1), near(random.chance(0.3) ? 0.5 : 4));
    query.direction = random.inBall();
    if (random.chance(0.2)) query.direction = {0, 0, random.chance(0.5) ? 2.0 : -3.0};
    query.distance = random.chance(0.1) ? 0 : random.chance(0.1) ? 1e12 : scale * random.uniform(0, 8);
    if (random.chance(0.2)) query.exclude = {0};
    if (random.chance(0.2)) query.mask = 2;
  }
  const std::vector<Result> results = CpuSweeper(scene, 2).run(queries).results;
  for (size_t q = 0; q < queries.size(); ++q) {
    INFO("seed " << seed << " scale " << scale << " far " << far << " query " << q);
    soups::check(scene, queries[q], results[q]);
  }
}

}  // namespace

TEST_CASE("the CPU's answers equal brute force on random soups") {
  for (uint64_t seed = 0; seed < 150; ++seed) runSoup(seed, 1, 0);
}

TEST_CASE("the CPU's answers equal brute force at every scale and far from the origin") {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    runSoup(1000 + seed, 1e-4, 1);
    runSoup(2000 + seed, 1e4, 0);
    runSoup(3000 + seed, 1, 1e7);
    runSoup(4000 + seed, 1e-4, 1e5);
    runSoup(5000 + seed, 1e-60, 0);
    runSoup(6000 + seed, 1e60, 0);
  }
}

TEST_CASE("the CPU's answers equal brute force for tiny sensors beside huge objects, and the other way round") {
  for (uint64_t seed = 0; seed < 150; ++seed) {
    Random random(7000 + seed);
    INFO("seed " << seed);
    Scene scene;
    const MeshId a = add(scene, soups::soup(random, 10, 0.6, 0.1)), b = add(scene, soups::soup(random, 10, 1.5, 0.1));
    const double sizeA = std::pow(10, random.uniform(-4, 4)), sizeB = std::pow(10, random.uniform(-4, 4));
    scene.addObject({b, random.pose(sizeB, {0, 0, 0})});
    scene.addObject({a, random.pose(sizeA, {0, 0, 5 * sizeA})});
    Query query;
    query.mesh = a;
    const double size = std::max(sizeA, sizeB);
    query.worldFromMesh =
        random.pose(sizeA, {0.5 * sizeB * random.uniform(-1, 1), 0.5 * sizeB * random.uniform(-1, 1), -2 * size});
    query.direction = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 1};
    query.distance = 20 * size;
    soups::check(scene, query, CpuSweeper(scene, 1).run({&query, 1}).results[0]);
  }
}

TEST_CASE("the CPU's answers equal brute force on integer lattices, where everything is degenerate") {
  for (uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    Scene scene;
    const int side = random.integer(1, 5);
    const MeshId sensor = add(scene, soups::lattice(random, random.integer(1, 12), side));
    for (int i = random.integer(1, 3); i-- > 0;) {
      const MeshId mesh = add(scene, soups::lattice(random, random.integer(1, 12), side));
      scene.addObject({mesh, soups::at(random.integer(-2, 2), random.integer(-2, 2), random.integer(0, 8))});
    }
    CpuSweeper sweeper(scene, 1);
    for (int q = 0; q < 3; ++q) {
      Query query;
      query.mesh = sensor;
      while (query.direction == std::array<double, 3>{}) {
        for (double& c : query.direction) c = random.chance(0.4) ? 0 : random.integer(-3, 3);
      }
      query.distance = random.integer(0, 12);
      INFO("seed " << seed << " query " << q);
      soups::check(scene, query, sweeper.run({&query, 1}).results[0]);
    }
  }
}
