// The checks of a device's arithmetic pass, and they detect an operation that is falsified on purpose.
#include "gpu/arithmetic.h"

#include <algorithm>
#include "support/catch.h"
#include "support/test_device.h"

using namespace radar;

namespace {

const char* const kNames[] = {"",
                              "float addition",
                              "float multiplication",
                              "float division",
                              "float x * y + z, declared precise",
                              "float inverse square root",
                              "float comparison, least and greatest",
                              "integer to float, below 2^24",
                              "loading and storing floats",
                              "float multiplication of subnormal numbers",
                              "float sums in two parts, declared precise",
                              "float differences in two parts, declared precise",
                              "double to two floats, by bits",
                              "float box around two corners, declared precise",
                              "double addition",
                              "double multiplication",
                              "double division",
                              "double division, composed of the above",
                              "double placement of a vertex, declared precise",
                              "double comparison, least and greatest",
                              "float to double, by bits",
                              "double to float",
                              "loading and storing doubles",
                              "what double sums and products lose, declared precise",
                              "double split into two floats"};
static_assert(std::size(kNames) == gpu::kOperations);

std::vector<std::string> failed(const gpu::Arithmetic& arithmetic) {
  std::vector<std::string> names;
  for (const ArithmeticCheck& check : arithmetic.checks) {
    if (!check.passed()) names.push_back(check.operation);
  }
  return names;
}

}  // namespace

TEST_CASE("a device's arithmetic passes every check, and its doubles are used unless they are switched off") {
  const std::vector<ArithmeticCheck> checks = checkArithmetic(test::device());
  CHECK(checks.size() == (test::wantsDoubles() ? 25 : 13));
  for (const ArithmeticCheck& check : checks) {
    CAPTURE(check.operation);
    CHECK(check.passed());
    CHECK(check.tried >= gpu::kTrials / 8);
  }
  CHECK(test::device().doubles() == test::wantsDoubles());
  CHECK(test::device().impl().dividesRight == test::wantsDoubles());
}

TEST_CASE("a falsified operation fails its check, and the engine no longer relies on it") {
  const bool hasDoubles = test::wantsDoubles();
  const uint32_t operations = hasDoubles ? gpu::kOperations : gpu::kDoubleSum;
  for (uint32_t falsified = 1; falsified < operations; ++falsified) {
    const gpu::Arithmetic found = gpu::tryArithmetic(test::device().impl(), hasDoubles, falsified);
    const std::vector<std::string> names = failed(found);
    CAPTURE(kNames[falsified], names);
    CHECK(std::count(names.begin(), names.end(), kNames[falsified]) == 1);
    const bool isFloat = falsified < gpu::kDoubleSum;
    CHECK(found.floats == !isFloat);
    CHECK(found.doubles == (hasDoubles && (isFloat || falsified == gpu::kDoubleQuotient)));
    CHECK(found.dividesRight == (hasDoubles && falsified != gpu::kDoubleQuotient));
  }
}
