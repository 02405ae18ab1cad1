// Searches recorded into a host's command buffers: the same answers, nothing submitted, waited for or allocated.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "embed/host.h"
#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "radar/host_geometry.h"
#include "radar/pool.h"
#include "radar/recorder.h"
#include "spirv/read_results_comp.h"
#include "support/test_device.h"
#include "workloads/families.h"
#include "workloads/shapes.h"

void recordQueries(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries);

namespace {

using namespace radar;

bool sameBits(const Result& p, const Result& q) {
  return std::memcmp(&p, &q, sizeof(Result)) == 0;
}

/// The host's renderer: its command buffer, and a pass that reads the answers, as tests/embed/read_results.comp says.
class Renderer {
 public:
  struct Seen {
    uint32_t status, object, flags;
    float t;
    float normal[3];
  };

  explicit Renderer(const Device& device)
      : device_(device.impl()),
        submission_(device_, false),
        bindings_(device_,
                  std::array<gpu::Binding, 2>{
                      {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}},
                  sizeof(uint32_t)),
        pipeline_(gpu::computePipeline(device_, bindings_.layout(), k_read_results_comp, "host's pass")),
        seen_(device_, "what the host sees", gpu::Residence::readback, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    seen_.reserve(4096 * sizeof(Seen));
    bindings_.setBuffer(1, seen_);
  }

  /// Records the queries, and behind the barrier that radar/recorder.h asks for the host's own pass.
  void record(Recorder& recorder, std::span<const Query> queries, bool withBarrier = true) {
    const gpu::Commands commands = submission_.begin();
    if (withBarrier) {
      recordQueries(commands, recorder, queries);
    } else {
      recorder.record(commands, queries);
    }
    const VkDescriptorBufferInfo results{recorder.results(), 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = bindings_.set(),
                                     .dstBinding = 0,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                     .pBufferInfo = &results};
    device_.vk.UpdateDescriptorSets(device_.device(), 1, &write, 0, nullptr);
    const auto count = static_cast<uint32_t>(queries.size());
    commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    bindings_.bind(commands);
    commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(count), &count);
    commands->CmdDispatch(commands, (count + 63) / 64, 1, 1);
  }
  void submitAndWait() { submission_.submitAndWait(); }
  const Seen& seen(size_t i) const { return reinterpret_cast<const Seen*>(seen_.mapped())[i]; }

 private:
  const Device::Impl& device_;
  gpu::Submission submission_;
  gpu::Bindings bindings_;
  gpu::Pipeline pipeline_;
  gpu::Buffer seen_;
};

/// Checks what the host's pass sees of an answer; returns whether it was left open.
bool isSeen(const Renderer::Seen& seen, const Result& expected) {
  if (seen.flags == kFlagOpen) {
    CHECK(seen.status == static_cast<uint32_t>(Status::undecided));
    CHECK(std::isnan(seen.t));
    return true;
  }
  CHECK(seen.flags == 0);
  CHECK(seen.status == static_cast<uint32_t>(expected.status));
  CHECK(seen.object == expected.object);
  if (std::isnan(expected.t)) {
    CHECK(std::isnan(seen.t));
  } else {
    CHECK(std::abs(seen.t) <= std::abs(expected.t));
    CHECK(seen.t == Approx(expected.t).epsilon(3e-7).margin(1e-37));
  }
  return false;
}

/// A row of boxes, each a step behind the last, and turned ones as sensors, some of which pass them all.
struct Row {
  explicit Row(uint32_t sensors) {
    const tools::MeshData box = tools::makeBox({1, 1, 1});
    mesh = scene.addMesh(box.positions, box.indices);
    for (uint32_t i = 0; i < 8; ++i) {
      scene.addObject({mesh, {{1, 0, 0, 1.1 * i, 0, 1, 0, 0.2, 0, 0, 1, 4.0 + i}}, ~0u});
    }
    for (uint32_t i = 0; i < sensors; ++i) {
      const Pose pose{{0.9, 0.1, 0.2, 0.7 * i - 1.2, -0.1, 0.9, 0.3, 0.1, -0.2, -0.3, 0.9, 0.01 * i}};
      queries.push_back({.mesh = mesh, .worldFromMesh = pose, .direction = {0, 0.01, 1}, .distance = 20});
    }
  }
  Scene scene;
  MeshId mesh;
  std::vector<Query> queries;
};

}  // namespace

TEST_CASE("recorded answers are those of a sweeper, bit for bit, on the device and read back") {
  constexpr Capacity kRoom{.queries = 48,
                           .clusters = 1u << 17,
                           .clusterPairs = 1u << 22,
                           .contenders = 1u << 15,
                           .dispatches = 40,
                           .openPairs = 1u << 17};
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Sweeper sweeper(test::device(), scene);
  Renderer renderer(test::device());
  for (const tools::Family family : tools::kFamilies) {
    const tools::Workload workload = tools::makeWorkload({.family = family, .queries = kRoom.queries, .seed = 5});
    tools::replaceBy(workload, 0, scene);
    std::vector<Query> queries;
    for (const auto& query : workload.queries) queries.push_back(tools::toQuery(query, Mode::contact, 0));
    for (size_t i = 0; i < queries.size(); i += 7) queries[i].decide = true;
    const Capacity need = recorder.need(queries);
    CHECK(need.queries == queries.size());
    CHECK(need.clusters <= kRoom.clusters);

    renderer.record(recorder, queries);
    renderer.submitAndWait();
    const std::vector<Result> read = recorder.read(), expected = sweeper.run(queries);
    size_t open = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(tools::nameOf(family), i);
      CHECK(sameBits(read[i], expected[i]));
      open += isSeen(renderer.seen(i), expected[i]);
    }
    if (test::device().doubles() && family == tools::Family::convex) CHECK(open <= 2);
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an open query keeps a certified lower bound until it is read") {
  // Two boxes flush along the way: contact at a whole number, where nothing but exact arithmetic is certain.
  const tools::Workload workload = tools::makeWorkload({.family = tools::Family::lattice, .queries = 96, .seed = 2});
  Scene scene;
  tools::replaceBy(workload, 0, scene);
  std::vector<Query> queries;
  for (const auto& query : workload.queries) queries.push_back(tools::toQuery(query, Mode::contact, 0));
  Recorder recorder(test::device(), scene, {.queries = 96, .clusterPairs = 1u << 20, .contenders = 2048});
  gpu::Submission submission(test::device().impl(), false);
  const auto execute = [&] {
    recorder.record(submission.begin(), queries);
    submission.submitAndWait();
  };
  execute();
  const std::vector<Result> settled = recorder.read();
  Recorder full(test::device(), scene, {.queries = 96, .clusterPairs = 1u << 20, .contenders = 2048, .openPairs = 1});
  full.record(submission.begin(), queries);
  submission.submitAndWait();
  const std::vector<Result> left = full.read();
  size_t open = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    CHECK(settled[i].flags == 0);
    if (left[i].flags == 0) continue;
    ++open;
    CHECK(left[i].flags == kFlagOpen);
    CHECK(left[i].status == Status::undecided);
    CHECK(std::isnan(left[i].hi));
    const double t = settled[i].status == Status::clear ? queries[i].distance : settled[i].lo;
    CHECK(left[i].lo <= t);
  }
  CHECK(open > 10);
}

TEST_CASE("what has changed in the scene since does not matter to reading") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  gpu::Submission submission(test::device().impl(), false);
  const std::vector<Result> expected = Sweeper(test::device(), row.scene).run(row.queries);
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  for (ObjectId id = 0; id < 8; ++id) row.scene.removeObject(id);
  row.scene.removeMesh(row.mesh);
  const std::vector<Result> read = recorder.read();
  for (size_t i = 0; i < read.size(); ++i) CHECK(sameBits(read[i], expected[i]));
}

TEST_CASE("a host that leaves the documented barrier out is told by synchronization validation") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  Renderer renderer(test::device());
  renderer.record(recorder, row.queries, false);
  renderer.submitAndWait();
  const std::vector<std::string> messages = test::takeValidationMessages();
  REQUIRE_FALSE(messages.empty());
  CHECK(messages[0].find("SYNC-HAZARD-READ-AFTER-WRITE") != std::string::npos);
  renderer.record(recorder, row.queries, true);
  renderer.submitAndWait();
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("what outgrows its room is invalid, says which, and leaves its neighbours alone") {
  Row row(12);
  const std::vector<Result> expected = Sweeper(test::device(), row.scene).run(row.queries);
  const auto [capacity, flag] = GENERATE(table<Capacity, uint32_t>({{{.clusters = 21}, kFlagClusters},
                                                                    {{.clusterPairs = 9}, kFlagClusterPairs},
                                                                    {{.contenders = 8}, kFlagContenders},
                                                                    {{.dispatches = 0}, kFlagDispatches}}));
  Recorder recorder(test::device(), row.scene, capacity);
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  const std::vector<Result> read = recorder.read();
  size_t refused = 0;
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(flag, i);
    if (read[i].status == Status::invalid) {
      ++refused;
      CHECK(read[i].flags == flag);
      CHECK(std::isnan(read[i].lo));
    } else {
      CHECK(sameBits(read[i], expected[i]));
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("what cannot be recorded is refused by the query's number, and nothing is recorded") {
  Row row(3);
  Recorder recorder(test::device(), row.scene, {.queries = 3});
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  const auto refused = [&](const char* why) {
    CHECK_THROWS_WITH(recorder.record(commands, row.queries), Catch::Contains(why));
  };
  row.queries[1].mode = Mode::bounded;
  refused("record: query 1: mode: expected contact");
  row.queries[1].mode = Mode::contact;
  row.queries[2].tolerance = 1;
  refused("record: query 2: tolerance: expected 0");
  row.queries[2].tolerance = 0;
  row.queries[0].direction = {};
  refused("record: query 0: direction");
  row.queries[0].direction = {0, 0, 1};
  row.queries[1].mesh = 9;
  refused("record: query 1: sensor: mesh 9 does not exist");
  CHECK_THROWS_WITH(recorder.need(row.queries), Catch::Contains("need: query 1: sensor: mesh 9 does not exist"));
  row.queries[1].mesh = row.mesh;
  recorder.record(commands, row.queries);
  submission.submitAndWait();
  CHECK(recorder.read()[2].status == Status::hit);
  row.queries.push_back(row.queries[0]);
  refused("expected at most 3 queries, got 4");
}

TEST_CASE("more room than a device has is refused, by the member that asks for it") {
  Row row(1);
  CHECK_THROWS_WITH(Recorder(test::device(), row.scene, {.clusterPairs = 1u << 31}),
                    Catch::Contains("Capacity::clusterPairs: this device allows"));
  CHECK_THROWS_WITH(Recorder(test::device(), row.scene, {.contenders = 1u << 30}),
                    Catch::Contains("Capacity::contenders: this device allows"));
}

TEST_CASE("commands that were never executed are made up for") {
  Row row(12);
  Recorder recorder(test::device(), row.scene);
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), row.queries);  // and begun anew: given up
  recorder.reset();
  recorder.record(submission.begin(), row.queries);
  submission.submitAndWait();
  const std::vector<Result> read = recorder.read(), expected = Sweeper(test::device(), row.scene).run(row.queries);
  for (size_t i = 0; i < read.size(); ++i) CHECK(sameBits(read[i], expected[i]));
}

TEST_CASE("a thousand frames of thirty sensors allocate nothing, submit nothing and wait for nothing") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::forget();
  {
    const Device device = Device::adopt(host.handles);
    Row row(30);
    constexpr uint32_t kInFlight = 2, kWarm = 4, kFrames = 1000;
    Renderer renderers[kInFlight] = {Renderer(hosts), Renderer(hosts)};
    Recorder recorders[kInFlight] = {Recorder(device, row.scene), Recorder(device, row.scene)};
    const test::Counts before = test::counts();
    int64_t allocations = 0, hits = 0;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
      if (frame == kWarm) allocations = test::counts().allocations;
      for (ObjectId id = 0; id < 8; ++id) {
        row.scene.setPose(id, {{1, 0, 0, 1.1 * id, 0, 1, 0, 0.2, 0, 0, 1, 4.0 + id + 0.001 * frame}});
      }
      Renderer& renderer = renderers[frame % kInFlight];
      renderer.record(recorders[frame % kInFlight], row.queries);
      renderer.submitAndWait();
      const Renderer::Seen& seen = renderer.seen(4);
      hits += seen.status == static_cast<uint32_t>(Status::hit) || (seen.flags == kFlagOpen && !device.doubles());
    }
    const test::Counts after = test::counts();
    CHECK(hits == kFrames);
    CHECK(after.allocations == allocations);
    CHECK(after.submissions == before.submissions);
    CHECK(after.waits == before.waits);
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
    isSeen(renderer.seen(i), expected[i]);
  }
  CHECK_THROWS_WITH(Sweeper(device, row.scene), "HostDevice::queue: a Sweeper submits, and there is none");
  CHECK_THROWS_WITH(Pool({&device, 1}, row.scene), "HostDevice::queue: a Pool submits, and there is none");
  CHECK_THROWS_WITH(addMesh(row.scene, device, HostMesh{}),
                    "HostDevice::queue: addMesh of a HostMesh submits, and there is none");
  CHECK(test::counts().submissions == 0);
  CHECK(test::counts().waits == 0);
}
