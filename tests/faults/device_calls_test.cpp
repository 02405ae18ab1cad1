// Every call of the device that may fail does so in turn, for lack of memory, in recordings and while setting up every
// allocation, too, and every submission because the device is lost. Answers are right, or invalid with the reason;
// afterwards the same objects answer with the same bits.
#include "embed/host.h"
#include "embed/host_world.h"
#include "faults/attempt.h"
#include "faults/scenario.h"
#include "fuzz/check_recorded.h"
#include "gpu/api.h"
#include "gpu/submission.h"
#include "radar/cpu_sweeper.h"
#include "support/same_bits.h"
#include "support/small_scenes.h"
#include "support/test_device.h"
#include "sweep/sweeper.h"

namespace {

using namespace radar;
using namespace test;

// Each answer is the expected one, or invalid with a reason that names the result; returns how many are.
size_t checkAnswers(const Answers& found, const Answers& expected, VkResult result) {
  REQUIRE(found.results.size() == expected.results.size());
  size_t invalid = 0;
  for (size_t i = 0; i < found.results.size(); ++i) {
    CAPTURE(i);
    if (found.results[i].status == Status::invalid) {
      ++invalid;
      CHECK_THAT(test::reasonFor(found, i), Contains(gpu::resultName(result)));
    } else {
      CHECK(sameBits(found.results[i], expected.results[i]));
    }
  }
  return invalid;
}

// A scene that grows beyond its buffers on the device.
class Growing {
 public:
  Growing() { test::SceneEdits().make(scene); }
  /// Adds objects, half of them of a new mesh if wanted.
  void grow(bool hasNewMesh) {
    MeshId added = 0;
    if (hasNewMesh) {
      const tools::MeshData box = tools::makeBox({1, 1, 1});
      std::vector<uint32_t> indices;
      for (int i = 0; i < 100; ++i) indices.insert(indices.end(), box.indices.begin(), box.indices.end());
      added = scene.addMesh(box.positions, indices);
    }
    for (int i = 0; i < 200; ++i) {
      scene.addObject({i % 2 == 0 ? added : 0, {{0.1, 0, 0, 0.05 * i, 0, 0.1, 0, 0.3, 0, 0, 0.1, 1}}});
    }
  }
  Scene scene;
};

}  // namespace

TEST_CASE(
    "whichever call of the device fails while a scene grows, answers are right or invalid, and later ones right") {
  const Device& device = test::watchedDevice();
  const test::BothModes queries;
  for (const bool hasNewMesh : {false, true}) {
    CAPTURE(hasNewMesh);
    Growing grown;
    grown.grow(hasNewMesh);
    Sweeper sweeper(device, grown.scene, {.cpuBatch = 0});
    const Answers expected = queries.answersBy(sweeper);
    const int64_t failed = failEach([&](int64_t n) {
      Growing growing;
      Sweeper other(device, growing.scene, {.timestamps = true, .cpuBatch = 0});
      queries.answersBy(other);
      growing.grow(hasNewMesh);
      Answers found;
      Attempt made = attempt(Of::device, n, [&] { found = queries.answersBy(other); });
      CAPTURE(made.function);
      CHECK_FALSE(made.threw);
      checkAnswers(found, expected, test::shortage(n));
      CHECK(sameBits(queries.answersBy(other), expected));
      return made;
    });
    CHECK(failed > 30);
  }
}

TEST_CASE(
    "whichever call of the device, or allocation, fails in a recording, the same recorder then records and reads right "
    "answers") {
  const Of of = GENERATE(Of::device, Of::host);
  const Device& device = test::watchedDevice();
  const std::vector<Query> queries = test::recordableQueries();
  Growing grown;
  grown.grow(false);
  const Answers expected = CpuSweeper(grown.scene, 1).run(queries);
  gpu::Submission submission(device.impl(), false);
  const int64_t failed = failEach([&](int64_t n) {
    Growing growing;
    Recorder recorder(device, growing.scene, test::kScenarioRoom);
    recorder.record(submission.begin(), queries);
    submission.submitAndWait();
    growing.grow(false);
    const gpu::Commands commands = submission.begin();
    const Attempt recorded = attempt(of, n, [&] { recorder.record(commands, queries); });
    CHECK((of == Of::host || recorded.threw == recorded.failed));
    if (recorded.threw) {
      CHECK(recorder.read().results.empty());
      recorder.reset();
      recorder.record(submission.begin(), queries);
    }
    submission.submitAndWait();
    Answers found;
    const Attempt read = attempt(of, n, [&] { found = recorder.read(); });
    if (read.threw) found = recorder.read();
    CHECK(sameContacts(found, expected));
    return Attempt{recorded.failed || read.failed, recorded.threw || read.threw};
  });
  CHECK(failed > (of == Of::device ? 10 : 30));
}

TEST_CASE(
    "whichever call of the device, or allocation, fails while a recorder lists what a host moves and deforms, the same "
    "recorder then records right answers") {
  const bool isBounded = GENERATE(true, false);
  const Of of = GENERATE(Of::device, Of::host);
  const Device& device = test::watchedDevice();
  gpu::Submission submission(device.impl(), false);
  const int64_t failed = failEach([&](int64_t n) {
    test::MovedWorld world(3, 5, {1, 4, 0}, test::always, test::never, device);
    Recorder recorder(device, world.scene,
                      {.queries = 16, .candidates = 1u << 14, .rounds = 32, .unresolvedPairs = 1u << 10});
    recorder.record(submission.begin(), world.queries(16), world.geometry());
    submission.submitAndWait();
    recorder.read();
    // Others are moved, and more than there was room for, and a mesh is deformed.
    std::optional<Bounds> bounds;
    if (isBounded) bounds = Bounds{{-4, -4, -4}, {4, 4, 4}};
    const MeshId mesh = test::addMesh(world.scene, tools::makeBox({1, 1, 1}), bounds);
    REQUIRE(test::addBox(world.truth, 4) == mesh);
    world.deformed = {mesh};
    for (uint32_t i = 0; i < 300; ++i) world.moved.push_back(world.add({mesh, {}, 3}));
    world.moveAgain();
    const HostGeometry geometry = world.geometry();
    const std::vector<Query> queries = world.queries(16);
    const gpu::Commands commands = submission.begin();
    Attempt made = attempt(of, n, [&] { recorder.record(commands, queries, geometry); });
    if (made.failed) {
      recorder.reset();
      recorder.record(submission.begin(), queries, geometry);
    }
    submission.submitAndWait();
    const Answers found = recorder.read();
    CHECK(recorder.boundsViolation().empty());
    fuzz::checkRecorded(queries, found, CpuSweeper(world.truth, 1).run(queries));
    return made;
  });
  CHECK(failed > 10);
}

TEST_CASE("whichever call of the device, or allocation, fails while setting up, it is named, and nothing is left") {
  test::Host host;
  const VkQueue queue = host.handles.queue;
  Scene scene;
  test::SceneEdits().make(scene);
  const auto failures = [&](Of of, const auto& setUp) {
    setUp();
    const int64_t objects = test::liveVulkanObjects(), blocks = test::host_memory::live();
    return failEach([&](int64_t n) {
      Attempt made = attempt(of, n, setUp);
      const bool waitsAgain = made.function == "vkWaitForFences";
      if (of == Of::device && made.failed) CHECK((made.threw || waitsAgain));
      CHECK(test::liveVulkanObjects() == objects);
      CHECK(test::host_memory::live() == blocks);
      return made;
    });
  };
  CHECK(failures(Of::device, [&] { Device::adopt(host.handles); }) > 30);
  const test::HollowPipelines hollow;
  host.handles.queue = VK_NULL_HANDLE;  // no checks of arithmetic: they would run the pipelines
  const auto everything = [&] {
    const Device device = Device::adopt(host.handles);
    const Recorder recorder(device, scene, test::kScenarioRoom);
    device.impl().host.queue = queue;
    Sweeper::Impl sweeper(device.impl(), scene, {.timestamps = true}, std::make_shared<GpuScene>(device.impl()));
    sweeper.sampled();
  };
  CHECK(failures(Of::device, everything) > 300);
  CHECK(failures(Of::host, everything) > 400);
}

TEST_CASE("if the device is lost at any submission, the CPU answers mode contact, and a new sweeper answers") {
  const Device& device = test::watchedDevice();
  Scene scene;
  test::SceneEdits().make(scene);
  for (const bool drawn : {false, true}) {
    const Mode mode = drawn ? Mode::sampled : Mode::contact;
    const std::vector<Query> queries = drawn ? test::sampledQueries() : test::contactQueries();
    Sweeper sweeper(device, scene, {.cpuBatch = 0});
    const Answers expected = sweeper.run(queries, mode);
    size_t invalid = 0;
    const int64_t failed = failEach([&](int64_t n) {
      Sweeper other(device, scene, {.timestamps = true, .cpuBatch = 0});
      bool happened = false;
      {
        const VulkanFault fault(n, VK_ERROR_DEVICE_LOST, VulkanFault::When::lost);
        for (int round = 0; round < 2; ++round) {
          CAPTURE(drawn, round, fault.failed());
          const Answers found = other.run(queries, mode);
          invalid += checkAnswers(found, expected, VK_ERROR_DEVICE_LOST);
          if (drawn) continue;
          CHECK(found.reasons.empty());
          CHECK(found.stats.lost.empty() != fault.happened());
          if (fault.happened()) CHECK_THAT(found.stats.lost, Contains("VK_ERROR_DEVICE_LOST"));
        }
        happened = fault.happened();
        if (happened) CHECK_THROWS_WITH(Device::adopt(device.handles()), Contains("VK_ERROR_DEVICE_LOST"));
      }
      Sweeper later(device, scene, {.cpuBatch = 0});
      CHECK(sameBits(later.run(queries, mode), expected));
      return Attempt{.failed = happened};
    });
    CHECK(failed > 2);
    CHECK((invalid > 0) == drawn);
  }
}
