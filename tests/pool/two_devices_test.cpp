#include <catch2/catch.hpp>

#include "radar/radar.h"
#include "support/test_device.h"

using namespace radar;

TEST_CASE("the tests of the pool see two usable devices, which open side by side") {
  const std::vector<DeviceReport> devices = listDevices();
  REQUIRE(devices.size() == 2);
  for (const DeviceReport& device : devices) CHECK(device.usable());
  const Device first = Device::open({.index = 0, .onValidation = test::onValidation});
  const Device second = Device::open({.index = 1, .onValidation = test::onValidation});
  CHECK(first.handles().physicalDevice != second.handles().physicalDevice);
}
