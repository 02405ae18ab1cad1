// Queries that ignore what does not block: the device's answers have the bits of the CPU's.
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "unit/soups.h"
#include "workloads/voxels.h"

using namespace radar;
using soups::Random;

namespace {

/// Solids that fit each other, in a common pose, and sweeps of the first one: at rest, beside it, and turned.
struct Batch {
  Scene scene;
  std::vector<Query> queries;
};

MeshId add(Scene& scene, const tools::MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

void addQueries(Batch& batch, Random& random, MeshId mesh, const Transform& rest, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    Query query{.mesh = mesh, .worldFromMesh = rest};
    for (double& c : query.direction) c = random.integer(-2, 2);
    if (query.direction == std::array<double, 3>{}) query.direction[0] = 1;
    if (random.chance(0.5)) {
      const std::array<double, 3> d = query.direction;
      for (size_t k = 0; k < 3; ++k) {
        query.direction[k] = rest.m[4 * k] * d[0] + rest.m[4 * k + 1] * d[1] + rest.m[4 * k + 2] * d[2];
      }
    }
    if (random.chance(0.2)) query.direction = random.inBall();
    if (random.chance(0.2)) query.worldFromMesh.m[3] += random.uniform(-3, 3);
    if (random.chance(0.1)) query.worldFromMesh = random.pose(1, {0, 0, 0});
    if (random.chance(0.2)) {
      for (size_t k : {0, 4, 8}) query.worldFromMesh.m[k] = -query.worldFromMesh.m[k];
    }
    query.distance = random.chance(0.1) ? 0 : random.uniform(0, 20);
    query.ignoreLeaving = !random.chance(0.1);
    query.anyHit = random.chance(0.2);
    if (random.chance(0.4)) query.slack = random.chance(0.5) ? 0 : random.uniform(0, 0.3);
    batch.queries.push_back(query);
  }
}

Batch batchOf(uint64_t seed) {
  Random random(seed);
  Batch batch;
  tools::Random draw(seed);
  const uint32_t side = 2 + draw.below(4), count = 2 + draw.below(4);
  const std::vector<tools::Solid> solids = tools::packedSolids(side, count, draw);
  Transform rest;
  if (random.chance(0.6)) rest = random.pose(std::exp(random.uniform(-6, 6)), {random.uniform(-50, 50), 0, 3});
  MeshId sensor = 0;
  for (const tools::Solid& solid : solids) {
    const MeshId mesh = add(batch.scene, tools::boundaryOf(solid, draw));
    if (&solid == &solids[0]) {
      sensor = mesh;
    } else {
      batch.scene.addObject({mesh, rest});
    }
  }
  if (random.chance(0.3)) {
    const MeshId mesh = soups::add(batch.scene, soups::lattice(random, random.integer(1, 12), 3));
    batch.scene.addObject({mesh, rest});
  }
  addQueries(batch, random, sensor, rest, 48);
  return batch;
}

Result withTier(Result result, Tier tier) {
  result.tier = tier;
  return result;
}

}  // namespace

TEST_CASE("the device's answers to queries that ignore what does not block have the CPU's bits") {
  size_t free = 0, resting = 0, later = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Batch batch = batchOf(seed);
    std::vector<Result> expected = CpuSweeper(batch.scene, 1).run(batch.queries).results;
    Sweeper sweeper(test::device(), batch.scene, {.cpuBatch = 0});
    const std::vector<Result> results = sweeper.run(batch.queries).results;
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("seed " << seed << " query " << i);
      expected[i].tier = results[i].tier;
      REQUIRE(test::sameBits(results[i], expected[i]));
      if (!batch.queries[i].ignoreLeaving) continue;
      free += results[i].status == Status::clear;
      resting += results[i].status == Status::overlap;
      later += results[i].status == Status::hit;
    }
  }
  REQUIRE(free > 150);
  REQUIRE(resting > 150);
  REQUIRE(later > 150);
}

TEST_CASE("boxes pressed together, though rounding has let them pass each other, have the CPU's bits") {
  Random random(5);
  for (int scene = 0; scene < 20; ++scene) {
    Batch batch;
    const MeshId box = soups::add(batch.scene, soups::box(0.5, 0.5, 0.5));
    const Transform rest = scene % 2 == 0 ? soups::at(0, 0, random.uniform(-9, 9)) : random.pose(1, {1, 2, 3});
    batch.scene.addObject({box, rest});
    for (int i = 0; i < 40; ++i) {
      Query query{.mesh = box, .worldFromMesh = rest, .distance = random.chance(0.5) ? 0.5 : 5};
      const double sunk = i % 4 == 0 ? random.uniform(0, 1e-3) : random.integer(-2, 2) * 0x1p-52;
      for (size_t k : {0, 1, 2}) {
        query.worldFromMesh.m[4 * k + 3] += (1 - sunk) * rest.m[4 * k + 2];
        query.direction[k] = -rest.m[4 * k + 2] + (i % 3 == 0 ? random.uniform(-1, 1) : 0);
      }
      query.ignoreLeaving = true;
      if (i % 4 == 0) query.slack = 1e-3;
      query.anyHit = i % 5 == 0;
      batch.queries.push_back(query);
    }
    std::vector<Result> expected = CpuSweeper(batch.scene, 1).run(batch.queries).results;
    Sweeper sweeper(test::device(), batch.scene, {.cpuBatch = 0});
    const std::vector<Result> results = sweeper.run(batch.queries).results;
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("scene " << scene << " query " << i);
      expected[i].tier = results[i].tier;
      REQUIRE(test::sameBits(results[i], expected[i]));
    }
  }
}

TEST_CASE("lists of the nearest objects, and of those that cross at the start, are the CPU's") {
  size_t listed = 0, crossing = 0, onDevice = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Batch batch = batchOf(seed);
    for (size_t i = 0; i < batch.queries.size(); ++i) {
      Query& query = batch.queries[i];
      if (!query.anyHit && i % 3 != 0) query.hits = i % 3 == 1 ? kAllHits : 2;
      query.skipOverlapping = i % 2 == 0;
    }
    CpuSweeper cpu(batch.scene, 1);
    const Answers expected = cpu.run(batch.queries);
    Sweeper sweeper(test::device(), batch.scene, {.cpuBatch = 0});
    const Answers found = sweeper.run(batch.queries);
    onDevice += batch.queries.size() - found.stats.cpuQueries;
    for (size_t i = 0; i < batch.queries.size(); ++i) {
      INFO("seed " << seed << " query " << i);
      REQUIRE(test::sameBits(found.results[i], withTier(expected.results[i], found.results[i].tier)));
      const std::vector<Result>&ours = found.lists[i].hits, &theirs = expected.lists[i].hits;
      REQUIRE(ours.size() == theirs.size());
      for (size_t k = 0; k < ours.size(); ++k) {
        REQUIRE(test::sameBits(ours[k], withTier(theirs[k], ours[k].tier)));
      }
      const std::vector<ObjectId>& skipped = found.lists[i].overlapping;
      REQUIRE(skipped == expected.lists[i].overlapping);
      listed += ours.size();
      crossing += skipped.size();
    }
  }
  REQUIRE(listed > 400);
  REQUIRE(crossing > 20);
  REQUIRE(onDevice > 300);
}

TEST_CASE("boxes that slide along each other but for a rounding, and so never touch, have the CPU's bits") {
  Random random(6);
  Batch batch;
  const MeshId box = soups::add(batch.scene, soups::box(0.5, 0.5, 0.5)),
               longBox = soups::add(batch.scene, soups::box(1.25, 0.5, 0.5));
  for (uint32_t i = 0; i < 30; ++i) {
    const Transform rest = random.pose(std::exp(random.uniform(-9, 1)), random.inBall());
    batch.scene.addObject({box, rest, 1u << i});
    for (int k = 0; k < 300; ++k) {
      Query query{.mesh = longBox, .worldFromMesh = rest, .distance = random.uniform(0, 5), .mask = 1u << i};
      const double along = random.uniform(-1.5, 1.5), down = std::exp(random.uniform(-37, -29)),
                   way = k % 2 == 0 ? 1 : -1;
      for (size_t row : {0, 1, 2}) {
        query.worldFromMesh.m[4 * row + 3] += rest.m[4 * row + 2] + along * rest.m[4 * row];
        query.direction[row] = way * rest.m[4 * row] - down * rest.m[4 * row + 2];
      }
      query.ignoreLeaving = true;
      batch.queries.push_back(query);
    }
  }
  const std::vector<Result> expected = CpuSweeper(batch.scene, 1).run(batch.queries).results;
  Sweeper sweeper(test::device(), batch.scene, {.cpuBatch = 0});
  const std::vector<Result> results = sweeper.run(batch.queries).results;
  size_t blocked = 0;
  for (size_t i = 0; i < results.size(); ++i) {
    INFO("query " << i);
    REQUIRE(test::sameBits(results[i], withTier(expected[i], results[i].tier)));
    blocked += results[i].status == Status::overlap;
  }
  REQUIRE(blocked > 100);
}

TEST_CASE("faces pressed together that touch a rounding ahead are faces, as on the CPU") {
  Random random(7);
  Batch batch;
  const MeshId large = batch.scene.addMesh(std::vector<float>{-1, -1, 0, 3, -1, 0, -1, 3, 0}, std::vector{0u, 1u, 2u});
  const MeshId small = batch.scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector{0u, 2u, 1u});
  for (uint32_t i = 0; i < 20; ++i) {
    const Transform rest = random.pose(1, {random.uniform(-1e5, 1e5), 3, 5});
    batch.scene.addObject({large, rest, 1u << i});
    for (int k = 0; k < 20; ++k) {
      Query query{.mesh = small, .worldFromMesh = rest, .distance = 5, .mask = 1u << i};
      const double above = random.uniform(0, 1e-10), aside = random.uniform(-1, 1);
      for (size_t row : {0, 1, 2}) {
        query.worldFromMesh.m[4 * row + 3] += above * rest.m[4 * row + 2];
        query.direction[row] = aside * rest.m[4 * row] - rest.m[4 * row + 2];
      }
      query.ignoreLeaving = true;
      batch.queries.push_back(query);
    }
  }
  CpuSweeper cpu(batch.scene, 1);
  const std::vector<Result> expected = cpu.run(batch.queries).results;
  Sweeper sweeper(test::device(), batch.scene, {.cpuBatch = 0});
  const std::vector<Result> results = sweeper.run(batch.queries).results;
  size_t ahead = 0;
  for (size_t i = 0; i < results.size(); ++i) {
    INFO("query " << i);
    REQUIRE(test::sameBits(results[i], withTier(expected[i], results[i].tier)));
    ahead += results[i].status == Status::hit && results[i].featureA == Feature::face;
  }
  REQUIRE(ahead > 50);
}

TEST_CASE("a body on a fine floor is answered by the device alone") {
  if (!test::device().doubles()) return;
  // Two floors of 20 x 20 squares: 800 triangles each, in one plane, under a box of 4 x 4 squares.
  tools::Solid floor, box;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) floor.insert({x, y, -1});
  }
  for (int x = 8; x < 12; ++x) {
    for (int y = 8; y < 12; ++y) box.insert({x, y, 0});
  }
  Random random(1);
  tools::Random draw(1);
  Scene scene;
  const Transform rest = random.pose(0.7, {5, -3, 2});
  scene.addObject({add(scene, tools::boundaryOf(floor, draw)), rest});
  const MeshId mesh = add(scene, tools::boundaryOf(box, draw));
  std::vector<Query> queries;
  for (int i = 0; i < 32; ++i) {
    Query query{.mesh = mesh, .worldFromMesh = rest, .distance = 30};
    const std::array<double, 3> d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.001, 1)};
    for (size_t k = 0; k < 3; ++k)
      query.direction[k] = rest.m[4 * k] * d[0] + rest.m[4 * k + 1] * d[1] + rest.m[4 * k + 2] * d[2];
    query.ignoreLeaving = true;
    queries.push_back(query);
  }
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  const Answers answers = sweeper.run(queries);
  for (const Result& result : answers.results) REQUIRE(result.status == Status::clear);
  REQUIRE(answers.stats.cpuQueries == 0);
  REQUIRE(answers.stats.cpuPairs == 0);
}
