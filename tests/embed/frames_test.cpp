// What a host's frames cost it: no allocation, no submission, no wait, of any engine that records.
#include <catch2/catch.hpp>

#include <array>

#include "embed/host.h"
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "radar/host_geometry.h"
#include "radar/pool.h"

namespace {

using namespace radar;
using test::Renderer;
using test::Row;
using test::sameBits;

// A scene that a frame shows, its queries and their answers.
struct Shown {
  tools::Workload workload;
  std::vector<Query> queries;
  std::vector<Result> expected;
};

std::vector<Shown> showFamilies(const Device& device, uint32_t queries) {
  Scene scene;
  Sweeper sweeper(device, scene);
  std::vector<Shown> all;
  for (const tools::Family family : tools::kFamilies) {
    Shown shown{tools::makeWorkload({.family = family, .queries = queries, .seed = 8}), {}, {}};
    tools::replaceBy(shown.workload, 0, scene);
    shown.queries = test::queriesOf(shown.workload);
    shown.expected = sweeper.run(shown.queries);
    all.push_back(std::move(shown));
  }
  return all;
}

}  // namespace

TEST_CASE("a thousand frames of all families allocate nothing, submit nothing and wait for nothing") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  const std::vector<Shown> families = showFamilies(hosts, 30);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::forget();
  {
    const Device device = Device::adopt(host.handles);
    Scene scene;
    constexpr Capacity kRoom{.queries = 30, .candidates = 1u << 16, .rounds = 64, .unresolvedPairs = 1u << 16};
    constexpr uint32_t kInFlight = 2, kFrames = 1000;
    Renderer renderers[kInFlight] = {Renderer(hosts), Renderer(hosts)};
    Recorder recorders[kInFlight] = {Recorder(device, scene, kRoom), Recorder(device, scene, kRoom)};
    const test::Counts before = test::counts();
    // By then both recorders have seen every family.
    const auto warm = static_cast<uint32_t>(kInFlight * families.size());
    int64_t allocations = 0;
    size_t wrong = 0;
    for (uint32_t frame = 0; frame < kFrames + kInFlight; ++frame) {
      if (frame == warm) allocations = test::counts().allocations;
      Renderer& renderer = renderers[frame % kInFlight];
      Recorder& recorder = recorders[frame % kInFlight];
      if (frame >= kInFlight) {
        // What was submitted two frames ago; the last frame is still with the device.
        const Shown& past = families[(frame - kInFlight) % families.size()];
        renderer.wait();
        const std::vector<Result> read = recorder.read();
        for (size_t i = 0; i < read.size(); ++i) wrong += !sameBits(read[i], past.expected[i]);
      }
      if (frame >= kFrames) continue;
      const Shown& shown = families[frame % families.size()];
      tools::replaceBy(shown.workload, 0, scene);
      renderer.record(recorder, shown.queries);
      renderer.submit();
    }
    const test::Counts after = test::counts();
    CHECK(wrong == 0);
    CHECK(after.allocations == allocations);
    CHECK(after.submissions == before.submissions);
    CHECK(after.waits == before.waits);
  }
  CHECK(test::counts().live == 0);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("frames in which objects move allocate nothing, and see them where they are") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::forget();
  {
    const Device device = Device::adopt(host.handles);
    Row row(30);
    Renderer renderer(hosts);
    Recorder recorder(device, row.scene);
    constexpr uint32_t kWarm = 2, kFrames = 100;
    int64_t allocations = 0, hits = 0;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
      if (frame == kWarm) allocations = test::counts().allocations;
      for (ObjectId id = 0; id < 8; ++id) {
        row.scene.setTransform(id, {{1, 0, 0, 1.1 * id, 0, 1, 0, 0.2, 0, 0, 1, 4.0 + id + 0.001 * frame}});
      }
      renderer.record(recorder, row.queries);
      renderer.submitAndWait();
      const Renderer::Seen& seen = renderer.seen(4);
      hits += seen.status == static_cast<uint32_t>(Status::hit) || (seen.flags == kFlagUnresolved && !device.doubles());
    }
    CHECK(hits == kFrames);
    CHECK(test::counts().allocations == allocations);
  }
  CHECK(test::counts().live == 0);
}

TEST_CASE("an engine without a queue records, submits nothing, and refuses by name what would have to") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);  // whose queue stands for the host's
  host.handles.queue = VK_NULL_HANDLE;
  host.handles.doubles = hosts.doubles();
  host.handles.getInstanceProcAddr = test::countingLoader();
  test::forget();
  const Device device = Device::adopt(host.handles);
  CHECK(device.doubles() == hosts.doubles());
  Row row(30);
  Recorder recorder(device, row.scene);
  Renderer renderer(hosts);
  renderer.record(recorder, row.queries);
  renderer.submitAndWait();
  const std::vector<Result> read = recorder.read(), expected = Sweeper(hosts, row.scene).run(row.queries);
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(i);
    CHECK(sameBits(read[i], expected[i]));
    test::isSeen(renderer.seen(i), expected[i]);
  }
  CHECK_THROWS_WITH(Sweeper(device, row.scene), "HostDevice::queue is null; a Sweeper needs a queue to submit to");
  CHECK_THROWS_WITH(Pool({&device, 1}, row.scene), "HostDevice::queue is null; a Pool needs a queue to submit to");
  CHECK_THROWS_WITH(addMesh(row.scene, device, HostMesh{}),
                    "HostDevice::queue is null; addMesh of a HostMesh needs a queue to submit to");
  CHECK(test::counts().submissions == 0);
  CHECK(test::counts().waits == 0);
}
