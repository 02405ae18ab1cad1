// Tests "without subnormal numbers" run where these are flushed to 0.
#include <bit>
#include <cstdlib>
#include <string>

#include "gpu/kernel_fixture.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"

using namespace radar;
using namespace radar::test;

TEST_CASE("products of subnormal floats are exact or flushed to 0, and flushed where the environment asks for it") {
  const char* setting = std::getenv("RADAR_TEST_SUBNORMALS");
  const bool flushes = isLavapipe() && setting != nullptr && std::string(setting) == "off";
  constexpr uint32_t kCount = 100;
  const gpu::Array<uint32_t> values = numbers("values", kCount), results = numbers("results", kCount);
  gpu::Passes passes(impl());
  run([&](const gpu::Commands& commands) {
    passes(commands, kMultiplyFloats, kCount, ScalePush{kCount, std::bit_cast<uint32_t>(16.0f)},
           {{kSlotValues, values}, {kSlotResults, results}});
  });
  for (uint32_t i = 0; i < kCount; ++i) {
    const uint32_t result = results.mapped()[i];
    CAPTURE(i, result);
    CHECK((result == 0 || (!flushes && result == 16 * i)));
  }
}

TEST_CASE("an object whose pose stretches subnormal coordinates is not missed") {
  // Spans 1 across the motion, and leads down by 0.005: in the mesh by a subnormal number.
  constexpr float kSide = 0x1p-79f, kDepth = 0x1.ep-127f, kFace[] = {0, 0, -kDepth, kSide, 0, 0, 0, kSide, 0};
  constexpr float kPlate[] = {-9, -9, 0, 9, -9, 0, 0, 9, 0}, kSensor[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  const double stretch = 0x1.8p118;
  Scene scene;
  const MeshId sensor = scene.addMesh(kSensor, triangle);
  scene.addObject({scene.addMesh(kFace, triangle), {{0x1p79, 0, 0, 0, 0, 0x1p79, 0, 0, 0, 0, stretch, 1}}});
  scene.addObject({scene.addMesh(kPlate, triangle), {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1 - stretch * kDepth / 2}}});
  const std::vector<Query> queries(8, Query{.mesh = sensor, .direction = {0, 0, 1}, .distance = 2});
  CpuSweeper cpu(scene);
  const std::vector<Result> expected = cpu.run(queries).results;
  CHECK(expected[0].object == 0);
  Sweeper sweeper(device(), scene, {.cpuBatch = 0});
  const Answers found = sweeper.run(queries);
  CHECK(found.stats.submissions > 0);
  CHECK(differenceOf(found.results, expected, sameButTier).empty());
}
