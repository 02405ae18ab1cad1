// Rounding of doubles to floats in a given direction.
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "math/rounding.h"
#include "support/catch.h"

namespace {

using radar::roundDown;
using radar::roundUp;

constexpr float kMost = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::denorm_min();

// Has any exponent if `wide`, otherwise one within or slightly beyond the range of floats.
double randomDouble(std::mt19937_64& random, bool wide) {
  const uint64_t bits = random();
  if (wide) return std::bit_cast<double>(bits);
  const double significand = std::bit_cast<double>((bits & 0x800fffffffffffffu) | 0x3ff0000000000000u);
  return std::ldexp(significand, static_cast<int>(random() % 290) - 155);
}

}  // namespace

TEST_CASE("a double is rounded to the next float in the given direction") {
  std::mt19937_64 random(3);
  for (int i = 0; i < 400'000; ++i) {
    const double x = randomDouble(random, i % 2 == 0);
    if (!std::isfinite(x)) continue;
    const float up = roundUp(x), down = roundDown(x);
    if (!(up >= x && std::nextafter(up, -INFINITY) < x)) FAIL("up: " << x << " became " << up);
    if (!(down <= x && std::nextafter(down, INFINITY) > x)) FAIL("down: " << x << " became " << down);
  }
}

TEST_CASE("a double that is a float stays as it is") {
  std::mt19937 random(5);
  for (int i = 0; i < 100'000; ++i) {
    const auto x = std::bit_cast<float>(static_cast<uint32_t>(random()));
    if (std::isnan(x)) continue;
    if (roundUp(x) != x || roundDown(x) != x) FAIL(x << " changed");
  }
  for (const float x : {0.0f, -0.0f, kLeast, -kLeast, kMost, -kMost, INFINITY, -INFINITY}) {
    CHECK(roundUp(x) == x);
    CHECK(roundDown(x) == x);
  }
}

TEST_CASE("doubles beyond the greatest float and below the least are rounded in the given direction, too") {
  CHECK(roundUp(1e300) == INFINITY);
  CHECK(roundDown(1e300) == kMost);
  CHECK(roundUp(-1e300) == -kMost);
  CHECK(roundDown(-1e300) == -INFINITY);
  CHECK(roundUp(1e-300) == kLeast);
  CHECK(roundDown(1e-300) == 0);
  CHECK(roundUp(-1e-300) == 0);
  CHECK(roundDown(-1e-300) == -kLeast);
}
