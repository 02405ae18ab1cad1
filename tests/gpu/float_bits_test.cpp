// Sums and products of floats in shaders by their bits: those of the CPU, which rounds to nearest.
#include <bit>
#include <cmath>
#include <random>

#include "gpu/kernel_fixture.h"
#include "spirv/float_bits_comp.h"
#include "support/catch.h"

namespace {

using namespace radar;

float floatOf(uint32_t bits) {
  return std::bit_cast<float>(bits);
}

/// Pairs of any bits, pairs of similar and of the least and greatest exponents, and pairs whose results are halfway
/// between two floats or nearly so.
std::vector<uint32_t> pairsOfFloats(uint32_t count) {
  constexpr uint32_t kSpecial[] = {0,          1,          0x7fffff,   0x800000,   0x800001,   0x3f800000,
                                   0x3f800001, 0x3f7fffff, 0x33800000, 0x34000000, 0x7f7fffff, 0x7f800000,
                                   0x7fc00000, 0x4b7fffff, 0x4b800000, 0x00400000, 0x20000000, 0x1fffffff};
  std::mt19937 random(41);
  std::vector<uint32_t> values;
  for (const uint32_t x : kSpecial) {
    for (const uint32_t y : kSpecial) {
      for (const uint32_t signs : {0u, 1u, 2u, 3u})
        values.insert(values.end(), {x | signs << 31, y | signs >> 1 << 31});
    }
  }
  while (values.size() < 2 * count) {
    uint32_t x = random(), y = random();
    const uint32_t kind = random() % 5;
    if (kind == 1) y = (y & 0x807fffffu) | ((x & 0x7f800000u) + (random() % 60 << 23));
    if (kind == 2) x &= 0x80ffffffu;
    if (kind == 3) y = (y & 0x80000000u) | ((254u << 23) - (x & 0x7f800000u) + (y & 0x7fffffu));
    // Few digits, so that sums and products are exact or end in a half.
    if (kind == 4) {
      x &= 0xfffff000u;
      y = (y & 0x807ff000u) | ((x & 0x7f800000u) + (random() % 30 << 23));
    }
    values.insert(values.end(), {x, y});
  }
  return values;
}

}  // namespace

TEST_CASE("shaders add, subtract and multiply the bits of floats as the CPU does, to the last bit") {
  const uint32_t count = 300'000;
  const std::vector<uint32_t> pairs = pairsOfFloats(count);
  gpu::Array<uint32_t> values(test::impl(), "values", gpu::BufferDomain::upload),
      results(test::impl(), "results", gpu::BufferDomain::readback);
  values.reserve(pairs.size());
  results.reserve(3 * size_t{count});
  std::copy(pairs.begin(), pairs.end(), values.mapped());
  const gpu::Kernel kernel(test::impl(), k_float_bits_comp, "float bits");
  gpu::KernelArguments arguments(kernel);
  arguments.set({{test::kSlotValues, values}, {test::kSlotResults, results}});
  test::run([&](const gpu::Commands& commands) { arguments.dispatch(commands, gpu::groupsFor(count, 64), count); });
  size_t subnormal = 0, inexact = 0, infinite = 0;
  for (size_t i = 0; i < count; ++i) {
    const float x = floatOf(pairs[2 * i]), y = floatOf(pairs[2 * i + 1]);
    const float expected[] = {x + y, x - y, x * y};
    const double exact[] = {double{x} + y, double{x} - y, double{x} * y};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t found = results.mapped()[3 * i + k];
      if (!std::isfinite(expected[k])) {
        if (std::isfinite(floatOf(found))) FAIL(x << ", " << y << ": result " << k << " is finite");
        ++infinite;
      } else if (found != std::bit_cast<uint32_t>(expected[k])) {
        FAIL(x << ", " << y << ": result " << k << ": expected " << expected[k] << ", got " << floatOf(found));
      }
      subnormal += std::fpclassify(expected[k]) == FP_SUBNORMAL;
      inexact += exact[k] != expected[k];
    }
  }
  CHECK(subnormal > 1000);
  CHECK(inexact > 100'000);
  CHECK(infinite > 1000);
  CHECK(test::takeValidationMessages().empty());
}
