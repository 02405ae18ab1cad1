// Recording costs a host's frames no allocation, no submission and no wait.
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

// The scene of a frame, its queries and their expected results.
struct FrameScene {
  tools::Workload workload;
  std::vector<Query> queries;
  std::vector<Result> expected;
};

std::vector<FrameScene> makeFrameScenes(const Device& device, uint32_t queries) {
  Scene scene;
  Sweeper sweeper(device, scene);
  std::vector<FrameScene> all;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    FrameScene content{tools::hardScene(family, 8, 0, queries, tools::Company::mixed), {}, {}};
    tools::replaceBy(content.workload, 0, scene);
    content.queries = test::queriesOf(content.workload);
    content.expected = sweeper.run(content.queries);
    all.push_back(std::move(content));
  }
  return all;
}

}  // namespace

TEST_CASE("recording a thousand frames of all families allocates nothing, submits nothing and waits for nothing") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  const std::vector<FrameScene> families = makeFrameScenes(hosts, 30);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::resetCounts();
  {
    const Device device = Device::adopt(host.handles);
    Scene scene;
    constexpr Capacity kRoom{.queries = 30, .candidates = 1u << 16, .rounds = 64, .unresolvedPairs = 1u << 16};
    constexpr uint32_t kInFlight = 2, kFrames = 1000;
    Renderer renderers[kInFlight] = {Renderer(hosts), Renderer(hosts)};
    Recorder recorders[kInFlight] = {Recorder(device, scene, kRoom), Recorder(device, scene, kRoom)};
    const test::Counts before = test::counts();
    // After that many frames both recorders have seen every family.
    const auto warm = static_cast<uint32_t>(kInFlight * families.size());
    int64_t allocations = 0;
    size_t wrong = 0;
    for (uint32_t frame = 0; frame < kFrames + kInFlight; ++frame) {
      if (frame == warm) allocations = test::counts().allocations;
      Renderer& renderer = renderers[frame % kInFlight];
      Recorder& recorder = recorders[frame % kInFlight];
      if (frame >= kInFlight) {
        // Reads the frame that was submitted two frames ago while the last one may still execute.
        const FrameScene& past = families[(frame - kInFlight) % families.size()];
        renderer.wait();
        const std::vector<Result> read = recorder.read();
        for (size_t i = 0; i < read.size(); ++i) wrong += !sameBits(read[i], past.expected[i]);
      }
      if (frame >= kFrames) continue;
      const FrameScene& content = families[frame % families.size()];
      tools::replaceBy(content.workload, 0, scene);
      renderer.record(recorder, content.queries);
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

TEST_CASE("recording frames in which objects move allocates nothing, and queries find the objects where they are") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::resetCounts();
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
      const Renderer::ShaderResult& result = renderer.shaderResult(4);
      hits +=
          result.status == static_cast<uint32_t>(Status::hit) || (result.flags == kFlagUnresolved && !device.doubles());
    }
    CHECK(hits == kFrames);
    CHECK(test::counts().allocations == allocations);
  }
  CHECK(test::counts().live == 0);
}

TEST_CASE("an engine without a queue records, submits nothing, and names the queue when it refuses what submits") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);  // its queue stands for the host's own
  host.handles.queue = VK_NULL_HANDLE;
  host.handles.doubles = hosts.doubles();
  host.handles.getInstanceProcAddr = test::countingLoader();
  test::resetCounts();
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
    test::checkShaderResult(renderer.shaderResult(i), expected[i]);
  }
  CHECK_THROWS_WITH(Sweeper(device, row.scene), "HostDevice::queue is null; a Sweeper needs a queue to submit to");
  CHECK_THROWS_WITH(Pool({&device, 1}, row.scene), "HostDevice::queue is null; a Pool needs a queue to submit to");
  CHECK_THROWS_WITH(addMesh(row.scene, device, HostMesh{}),
                    "HostDevice::queue is null; addMesh of a HostMesh needs a queue to submit to");
  CHECK(test::counts().submissions == 0);
  CHECK(test::counts().waits == 0);
}
