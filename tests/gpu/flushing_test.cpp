// Tests "without subnormal numbers" run where these are flushed to 0.
#include <bit>
#include <cstdlib>
#include <string>

#include "gpu/kernel_fixture.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::test;

TEST_CASE("products of subnormal floats are exact or flushed to 0, and flushed where the environment asks for it") {
  const char* setting = std::getenv("RADAR_TEST_SUBNORMALS");
  const bool flushes = setting != nullptr && std::string(setting) == "off";
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
