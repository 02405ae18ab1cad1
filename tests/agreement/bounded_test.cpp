// Mode bounded against the reference: the bracket holds whatever the scene, and it is worth having.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "gpu/device.h"
#include "reference/reference.h"
#include "support/test_device.h"
#include "workloads/generate.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using test::BoundedTally;
using test::compareBounded;
using tools::MeshData;
using tools::Random;
using tools::Vec3;

constexpr double kApart = 40;

double median(std::vector<double> values) {
  REQUIRE_FALSE(values.empty());
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// Pairs of convex meshes, each sensor before an object of its own that it may hit.
struct ConvexPairs {
  explicit ConvexPairs(uint32_t count) {
    Random random(41);
    std::vector<MeshId> meshes;
    for (const MeshData& mesh : {tools::makeBox({1, 2, 3}), tools::makeBox({2, 2, 2}), tools::makeUvSphere(20, 30)}) {
      meshes.push_back(scene.addMesh(mesh.positions, mesh.indices));
    }
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3 home{kApart * i, 0, 0}, direction = random.direction(), aside = random.inBox({-1, -1, -1}, {1, 1, 1});
      const auto scale = [&] {
        return Vec3{random.uniform(0.5, 1.5), random.uniform(0.5, 1.5), random.uniform(0.5, 1.5)};
      };
      scene.addObject({meshes[random.below(3)], tools::makePose(random.rotation(), scale(), home), ~0u});
      Vec3 start;
      for (int k = 0; k < 3; ++k) start[k] = home[k] - 8 * direction[k] + aside[k];
      queries.push_back({.mesh = meshes[random.below(3)],
                         .worldFromMesh = tools::makePose(random.rotation(), scale(), start),
                         .direction = direction,
                         .distance = 16});
    }
  }
  Scene scene;
  std::vector<Query> queries;
};

// Scenes of every kind; radar_random_queries has the families that are known to be hard.
BoundedTally everyKind(uint32_t resolution) {
  const uint64_t seed = 5;
  BoundedTally tally;
  for (const double origin : {0.0, 1e7}) {
    for (const uint32_t triangles : {8u, 70u}) {
      tally.add(compareBounded(
          tools::makeWorkload(tools::Soups{.sensors = 96, .triangles = triangles, .origin = origin, .seed = seed}),
          resolution));
    }
  }
  tally.add(compareBounded(
      tools::makeWorkload(tools::Table1{.sensors = 24, .shape = tools::SensorShape::box, .seed = seed}), resolution));
  tally.add(compareBounded(tools::makeWorkload(tools::Table1{.sensors = 8, .seed = seed}), resolution));
  tally.add(compareBounded(tools::makeWorkload(tools::Figure7{.teapots = 8, .steps = 1, .seed = seed}), resolution));
  return tally;
}

}  // namespace

TEST_CASE("on workloads of every kind the bracket holds") {
  const uint32_t resolution = GENERATE(37, 0);
  CAPTURE(resolution);
  const BoundedTally tally = everyKind(resolution);
  CHECK(tally.found >= 100);
  CHECK(tally.clear >= 100);
  CHECK(tally.decided() >= 0.9);
}

TEST_CASE("a bracket holds at one pixel and at a thousand") {
  const uint32_t resolution = GENERATE(1, 2, 1024);
  const BoundedTally tally =
      compareBounded(tools::makeWorkload(tools::Soups{.objects = 60, .sensors = 32, .seed = 3}), resolution);
  CHECK(tally.contacts >= 5);
}

TEST_CASE("on real meshes the bracket holds") {
  BoundedTally tally = compareBounded(
      tools::makeWorkload(tools::RandomPoses{.meshes = test::assimpModels(), .objects = 300, .sensors = 40}), 32);
  tally.add(compareBounded(
      tools::makeWorkload(tools::RandomPoses{.meshes = test::cgalMeshes(), .objects = 300, .sensors = 40}), 32));
  CHECK(tally.found >= 20);
}

TEST_CASE("the bracket holds in any unit, and whatever straddles the sensor") {
  const double unit = GENERATE(1e-12, 1e-5, 1e5, 1e12);
  CAPTURE(unit);
  tools::Workload workload =
      tools::makeWorkload(tools::Soups{.objects = 60, .sensors = 64, .triangles = 40, .seed = 9});
  for (tools::QuerySpec& query : workload.queries) query.distance *= unit;
  const auto enlarge = [&](tools::Instance& instance) {
    for (double& value : instance.worldFromMesh.m) value *= unit;
  };
  for (tools::SceneSpec& scene : workload.scenes)
    std::for_each(scene.instances.begin(), scene.instances.end(), enlarge);
  for (tools::QuerySpec& query : workload.queries) enlarge(query.sensor);
  const BoundedTally tally = compareBounded(workload, 64);
  CHECK(tally.found >= 10);
  CHECK(tally.decided() >= 0.8);
}

TEST_CASE("a small sensor over a vast floor, near and far, has a bracket") {
  Scene scene;
  const std::vector<float> corners{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const MeshId floor = scene.addMesh(corners, std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  const MeshData box = tools::makeBox({1, 1, 1});
  const MeshId sensor = scene.addMesh(box.positions, box.indices);
  const double size = GENERATE(10.0, 1e5, 1e12);
  CAPTURE(size);
  scene.addObject({floor, {{size, 0, 0, 0, 0, size, 0.1 * size, 0, 0, 0.01 * size, size, 0}}, ~0u});
  std::vector<Query> queries;
  for (const double height : {0.75, 1.0, 20.0, 1e6}) {
    for (const double distance : {0.0, 0.5, 30.0, 1e7}) {
      Query query{.mesh = sensor, .direction = {0.1, 0, -1}, .distance = distance};
      query.worldFromMesh.m[11] = height;
      queries.push_back(query);
    }
  }
  CHECK(compareBounded(scene, queries, 64).contacts >= 4);
}

TEST_CASE("of convex pairs the bracket is a few pixels wide, and halves with them") {
  const ConvexPairs pairs(160);
  double before = 0;
  for (const uint32_t resolution : {64u, 128u, 256u}) {
    const BoundedTally tally = compareBounded(pairs.scene, pairs.queries, resolution);
    REQUIRE(tally.found >= 80);
    const double pixels = median(tally.widthInPixels), width = pixels / resolution;
    WARN("at " << resolution << " the median of hi - lo is " << pixels << " pixels");
    CHECK(pixels < 8);
    if (before > 0) CHECK(width <= 0.6 * before);
    before = width;
  }
}

TEST_CASE("of plates that face each other the bracket is as narrow as the margins for float") {
  // Their depth is the same in all pixels, so nothing else widens it.
  Random random(8);
  const std::vector<float> corners{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  Scene scene;
  const MeshId plate = scene.addMesh(corners, std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 64; ++i) {
    const Vec3 home{kApart * i, 0, 0};
    const std::array<double, 9> turn = random.rotation();
    const Vec3 direction{turn[2], turn[5], turn[8]};
    const double away = random.uniform(0.01, 10);
    const Vec3 start{home[0] - away * direction[0], -away * direction[1], -away * direction[2]};
    scene.addObject({plate, tools::makePose(turn, {1, 1, 1}, home), ~0u});
    queries.push_back({.mesh = plate,
                       .worldFromMesh = tools::makePose(turn, {2, 1, 1}, start),
                       .direction = direction,
                       .distance = 12,
                       .mode = Mode::bounded,
                       .resolution = 64});
  }
  std::vector<double> widths;
  for (const Result& result : Sweeper(test::device(), scene).run(queries)) {
    REQUIRE(result.status == Status::hit);
    widths.push_back((result.hi - result.lo) / (4 + 12));
  }
  WARN("the median of hi - lo is " << median(widths) << " of size + D");
  CHECK(median(widths) < 1e-5);
}

TEST_CASE("on Table 1 the bracket decides nine of ten queries against the distance") {
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    const BoundedTally tally =
        compareBounded(tools::makeWorkload(tools::Table1{.boxes = 30'000, .sensors = 32, .shape = shape}), 256);
    WARN((shape == tools::SensorShape::box ? "boxes" : "teapots") << ": decided " << 100 * tally.decided() << "%");
    CHECK(tally.decided() >= 0.9);
  }
}

TEST_CASE("a tolerance ends refining, and ends mode contact before the exact search where it is met") {
  ConvexPairs pairs(64);
  Sweeper sweeper(test::device(), pairs.scene);
  for (Query& query : pairs.queries) query.tolerance = 0.5;
  const std::vector<Result> contact = sweeper.run(pairs.queries);
  for (Query& query : pairs.queries) query.mode = Mode::bounded;
  const std::vector<Result> refined = sweeper.run(pairs.queries);
  for (Query& query : pairs.queries) query.tolerance = 1e-3;
  const std::vector<Result> finest = sweeper.run(pairs.queries);
  uint32_t bounded = 0, exact = 0, coarse = 0;
  for (size_t i = 0; i < contact.size(); ++i) {
    CAPTURE(i, contact[i].lo, contact[i].hi, refined[i].lo, refined[i].hi);
    CHECK(contact[i].status != Status::undecided);
    if (contact[i].status != Status::hit) continue;
    CHECK(contact[i].hi - contact[i].lo <= 0.5);
    bounded += contact[i].tier == Tier::bounded;
    exact += contact[i].tier == Tier::contact;
    if (refined[i].status != Status::hit) continue;
    CHECK((refined[i].hi - refined[i].lo <= 0.5 || refined[i].resolution == 256));
    coarse += refined[i].resolution == 64;
    CHECK(finest[i].resolution == 256);
    CHECK(finest[i].lo >= refined[i].lo);
    CHECK(finest[i].hi <= refined[i].hi);
  }
  CHECK(bounded >= 20);
  CHECK(exact >= 1);
  CHECK(coarse >= 20);
}

TEST_CASE("to decide, a bracket on one side of the distance is enough") {
  const tools::Workload workload = tools::makeWorkload(tools::Soups{.objects = 60, .sensors = 96, .seed = 12});
  tools::ScenePlayer player(workload);
  player.show(0);
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::bounded));
  Sweeper sweeper(test::device(), player.scene());
  const std::vector<Result> exact = reference::Reference(player.scene()).run(queries);
  for (Query& query : queries) query.decide = true;
  const std::vector<Result> results = sweeper.run(queries);
  uint32_t coarse = 0, decided = 0;
  for (size_t i = 0; i < results.size(); ++i) {
    const Result& result = results[i];
    if (result.status == Status::undecided) continue;
    ++decided;
    coarse += result.status == Status::hit && result.resolution == 64;
    CHECK((result.status == Status::clear) == (exact[i].status == Status::clear));
    CHECK((result.status == Status::hit || result.status == Status::clear));
    CHECK((std::isnan(result.t) && result.object == kNone));
  }
  CHECK(decided >= 85);
  CHECK(coarse >= 20);
}

TEST_CASE("a bracket does not depend on how outer scopes are drawn") {
  const tools::Workload workload = tools::makeWorkload(tools::Soups{.sensors = 40, .triangles = 30, .seed = 13});
  tools::ScenePlayer player(workload);
  player.show(0);
  const uint32_t resolution = GENERATE(24, 64, 100);
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) {
    queries.push_back(tools::toQuery(spec, Mode::bounded, resolution));
  }
  Sweeper sweeper(test::device(), player.scene());
  std::optional<bool>& byPixel = test::device().impl().outerByPixel;
  const std::vector<Result> measured = sweeper.run(queries);
  byPixel = true;
  const std::vector<Result> pixels = sweeper.run(queries);
  byPixel = false;
  const std::vector<Result> triangles = sweeper.run(queries);
  byPixel.reset();
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (size_t i = 0; i < queries.size(); ++i) {
    for (const Result& other : {pixels[i], triangles[i]}) {
      CHECK(measured[i].status == other.status);
      CHECK((same(measured[i].lo, other.lo) && same(measured[i].hi, other.hi)));
      CHECK((measured[i].object == other.object && measured[i].triA == other.triA && measured[i].triB == other.triB));
    }
  }
}

TEST_CASE("a bracket does not depend on the batch it is asked in") {
  const tools::Workload workload = tools::makeWorkload(tools::Soups{.sensors = 40, .triangles = 30, .seed = 6});
  tools::ScenePlayer player(workload);
  player.show(0);
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::bounded, 64));
  Sweeper sweeper(test::device(), player.scene()), cramped(test::device(), player.scene(), {.pictureBytes = 1 << 18});
  const std::vector<Result> together = sweeper.run(queries), parts = cramped.run(queries);
  CHECK(cramped.stats().submissions > 1);
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (size_t i = 0; i < queries.size(); ++i) {
    const Result alone = sweeper.run({&queries[i], 1})[0];
    for (const Result& other : {together[i], parts[i]}) {
      CHECK(alone.status == other.status);
      CHECK((same(alone.lo, other.lo) && same(alone.hi, other.hi)));
      CHECK((alone.object == other.object && alone.triA == other.triA && alone.triB == other.triB));
    }
  }
}
