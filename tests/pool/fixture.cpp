#include "pool/fixture.h"

#include "support/same_bits.h"
#include "support/test_device.h"

namespace radar::test {

const TwoHosts& twoHosts() {
  return onceInRun([] { return TwoHosts(); });
}

std::span<const Device> twoDevices() {
  return onceInRun([] {
    std::vector<Device> devices;
    for (const Host* host : {&twoHosts().first, &twoHosts().second}) devices.push_back(Device::adopt(host->handles));
    return devices;
  });
}

Boxes::Boxes(uint32_t sensors, uint32_t boxes)
    : workload(tools::makeWorkload(
          tools::Table1{.boxes = boxes, .sensors = sensors, .shape = tools::SensorShape::box, .seed = 31})),
      player(workload) {
  player.show(0);
  queries = tools::queriesOf(workload.queries, 16);
}

std::vector<Result> Boxes::answers(Mode mode) const {
  Sweeper sweeper(twoDevices()[0], player.scene(), kOnDevice);
  return sweeper.run(queries, mode).results;
}

size_t differences(std::span<const Result> a, std::span<const Result> b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += !sameBits(a[i], b[i]);
  return count;
}

}  // namespace radar::test
