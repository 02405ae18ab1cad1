// Mode sampled against the reference, on seeded workloads of every kind.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "reference/reference.h"
#include "support/test_device.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

// First contact of one triangle pair alone: NaN where there is none.
double pairContact(const Scene& scene, const Query& query, const Result& result) {
  const auto triangleOf = [&](MeshId mesh, uint32_t triangle) {
    const MeshView view = scene.mesh(mesh);
    std::vector<float> corners;
    for (uint32_t i = 0; i < 3; ++i) {
      const float* p = &view.positions[3 * size_t{view.indices[3 * size_t{triangle} + i]}];
      corners.insert(corners.end(), p, p + 3);
    }
    return corners;
  };
  const std::vector<uint32_t> indices{0, 1, 2};
  Scene pair;
  const Object& object = scene.object(result.object);
  const MeshId b = pair.addMesh(triangleOf(object.mesh, result.triB), indices);
  Query alone = query;
  alone.mesh = pair.addMesh(triangleOf(query.mesh, result.triA), indices);
  alone.exclude.clear();
  alone.mask = ~0u;
  pair.addObject({b, object.worldFromMesh, ~0u});
  return reference::Reference(pair).answer(alone).t;
}

double sensorSize(const Scene& scene, const Query& query) {
  const MeshView mesh = scene.mesh(query.mesh);
  std::array<double, 3> lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  for (uint32_t vertex : mesh.indices) {
    const std::array<double, 3> p = place(query.worldFromMesh, &mesh.positions[3 * size_t{vertex}]);
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], p[k]);
      hi[k] = std::max(hi[k], p[k]);
    }
  }
  return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
}

struct Tally {
  uint32_t queries = 0, contacts = 0, found = 0, clear = 0;
  std::vector<double> excessInPixels;
};

// Every promise that a single sampled answer makes.
void checkAnswer(const Scene& scene, const Query& query, const Result& sampled, const Result& exact, Tally& tally) {
  ++tally.queries;
  const bool contact = exact.status == Status::hit || exact.status == Status::overlap;
  tally.contacts += contact;
  CHECK(sampled.status != Status::invalid);
  if (sampled.status == Status::clear) {
    ++tally.clear;
    CHECK_FALSE(contact);
    CHECK(sampled.tier == Tier::select);
    CHECK(sampled.detected == Detected::no);
    return;
  }
  CHECK(sampled.tier == Tier::sampled);
  CHECK(sampled.lo == 0);
  if (sampled.status == Status::undecided) {
    CHECK(std::isnan(sampled.hi));
    CHECK(sampled.object == kNone);
    return;
  }
  ++tally.found;
  REQUIRE(contact);
  CHECK(sampled.hi <= query.distance);
  CHECK(sampled.t == sampled.hi);
  // The reference rounds its t; `hi` adds its error bound to its own rounding.
  const double rounding = 0x1p-50 * (exact.t + sensorSize(scene, query));
  CHECK(sampled.hi >= exact.t - rounding);
  if (sampled.status == Status::overlap) CHECK(exact.status == Status::overlap);
  const double own = pairContact(scene, query, sampled);
  CHECK(sampled.hi <= own + 1e-6 * std::max(sensorSize(scene, query), own));
  CHECK(sampled.hi >= own - rounding);
  if (sampled.resolution != 0) {
    tally.excessInPixels.push_back((sampled.hi - exact.t) * sampled.resolution / sensorSize(scene, query));
  }
}

Tally compare(const tools::Workload& workload, uint32_t resolution) {
  Tally tally;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(test::device(), player.scene());
  reference::Reference exact(player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    for (uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], resolution));
    const std::vector<Result> sampled = sweeper.run(queries);
    const std::vector<Result> truth = exact.run(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      INFO("query " << workload.queries[batch.queries[i]].id << " at " << resolution);
      checkAnswer(player.scene(), queries[i], sampled[i], truth[i], tally);
    }
  }
  return tally;
}

double median(std::vector<double> values) {
  REQUIRE_FALSE(values.empty());
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace

TEST_CASE("on soups of every kind hi is never below the exact answer and close to its own pair's") {
  const uint64_t seed = GENERATE(1, 2, 3);
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const uint32_t resolution = GENERATE(16, 64, 256);
  const Tally tally = compare(
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = 100, .origin = origin, .seed = seed}), resolution);
  CAPTURE(seed, origin, resolution, tally.contacts, tally.found, tally.clear);
  CHECK(tally.found > 0);
}

TEST_CASE("at 256 nearly all contacts of Table 1 are found, less than a pixel late") {
  const auto shape = GENERATE(tools::SensorShape::box, tools::SensorShape::teapot);
  const Tally tally = compare(tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape}), 256);
  CAPTURE(tally.contacts, tally.found);
  CHECK(tally.found >= 0.95 * tally.contacts);
  CHECK(median(tally.excessInPixels) < 1);
}

TEST_CASE("at 256 nearly all contacts of Figure 7 are found, less than a pixel late") {
  const Tally tally = compare(tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12}), 256);
  CAPTURE(tally.contacts, tally.found);
  CHECK(tally.found >= 0.95 * tally.contacts);
  CHECK(median(tally.excessInPixels) < 1);
}

TEST_CASE("the error falls as the resolution grows") {
  const tools::Workload workload =
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 128, .shape = tools::SensorShape::teapot});
  double before = 1e300;
  for (uint32_t resolution : {16u, 64u, 256u}) {
    Tally tally = compare(workload, resolution);
    double mean = 0;  // in units of the sensor, misses as a whole sensor
    for (double excess : tally.excessInPixels) mean += excess / resolution;
    mean = (mean + tally.contacts - tally.found) / tally.contacts;
    CAPTURE(resolution, mean, before);
    CHECK(mean < before);
    before = mean;
  }
}
