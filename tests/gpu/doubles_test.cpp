// Devices with doubles and without.
#include <catch2/catch.hpp>

#include "gpu/device.h"
#include "gpu/doubles.h"
#include "support/test_device.h"

using namespace radar;

TEST_CASE("a device uses doubles if it has them, they pass the self-test and nobody switched them off") {
  CHECK(test::device().doubles() == test::wantsDoubles());
  if (test::wantsDoubles()) CHECK(gpu::doublesAreRight(test::device().impl()));
}
