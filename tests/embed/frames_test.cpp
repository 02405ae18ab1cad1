// Recording costs a host's frames no allocation, no submission and no wait.
#include "embed/checks.h"
#include "embed/host_world.h"
#include "embed/quiet_frames.h"
#include "embed/renderer.h"
#include "radar/host.h"
#include "radar/pool.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using namespace test;

/// Scenes of all families in turn. Two frames are in flight, each with a recorder of its own.
struct FamilyFrames {
  static constexpr uint32_t kInFlight = 2, kFrames = 200;
  static constexpr Capacity kRoom{.queries = 30, .candidates = 1u << 16, .rounds = 64, .unresolvedPairs = 1u << 16};
  struct Content {
    tools::Workload workload;
    std::vector<Query> queries;
    std::vector<Result> expected;
  };

  FamilyFrames(const Device& engine, const Device& hosts)
      : renderers{Renderer(hosts), Renderer(hosts)},
        recorders{Recorder(engine, scene, kRoom), Recorder(engine, scene, kRoom)} {
    Scene other;
    Sweeper sweeper(hosts, other);
    for (const tools::HardFamily& family : test::recordableFamilies()) {
      Content content{tools::hardScene(family, 8, 0, kRoom.queries, tools::Company::mixed), {}, {}};
      tools::replaceBy(content.workload, 0, other);
      content.queries = test::queriesOf(content.workload);
      content.expected = sweeper.run(content.queries).results;
      families.push_back(std::move(content));
    }
  }
  void operator()(uint32_t frame) {
    Renderer& renderer = renderers[frame % kInFlight];
    Recorder& recorder = recorders[frame % kInFlight];
    if (frame >= kInFlight) {
      // Reads the frame that was submitted two frames ago while the last one may still execute.
      renderer.wait();
      checkSame(recorder.read().results, families[(frame - kInFlight) % families.size()].expected);
    }
    if (frame >= kFrames) return;
    const Content& content = families[frame % families.size()];
    tools::replaceBy(content.workload, 0, scene);
    renderer.record(recorder, content.queries);
    renderer.submit();
  }
  std::vector<Content> families;
  Scene scene;
  Renderer renderers[kInFlight];
  Recorder recorders[kInFlight];
};

}  // namespace

TEST_CASE("recording 200 frames of all families allocates nothing, submits nothing and waits for nothing") {
  // After that many frames both recorders have seen every family.
  const auto warm = static_cast<uint32_t>(FamilyFrames::kInFlight * test::recordableFamilies().size());
  test::checkQuiet<FamilyFrames>(FamilyFrames::kFrames + FamilyFrames::kInFlight, warm);
}

TEST_CASE("three recorders in flight and a sweeper share one copy of a scene that moves, deforms, grows and shrinks") {
  tools::Random random(3);
  Scene scene;
  std::vector<MeshId> meshes;
  const auto addMesh = [&] {
    const tools::MeshData soup = tools::makeSoup(tools::Soup::plain, 1 + random.below(40), random);
    meshes.push_back(test::addMesh(scene, soup));
  };
  const auto anyMesh = [&] { return meshes[random.below(static_cast<uint32_t>(meshes.size()))]; };
  const auto somewhere = [&] { return random.affine(random.inCube(12)); };
  const auto edit = [&](uint32_t frame) {
    // Every tenth frame needs larger buffers while two others are in use.
    for (uint32_t added = frame % 10 == 5 ? 40 + 3 * frame : 2; added-- > 0;) scene.addObject({anyMesh(), somewhere()});
    if (frame % 10 == 7) addMesh();
    const ObjectId id = random.below(scene.objectLimit());
    if (scene.hasObject(id)) scene.removeObject(id);
    for (int i = 0; i < 5; ++i) {
      const ObjectId moved = random.below(scene.objectLimit());
      if (scene.hasObject(moved)) scene.setTransform(moved, somewhere());
    }
    const MeshId deformed = anyMesh();
    std::vector<float> positions(scene.mesh(deformed).positions.begin(), scene.mesh(deformed).positions.end());
    for (float& p : positions) p += static_cast<float>(random.uniform(-0.1, 0.1));
    scene.setPositions(deformed, positions);
  };
  for (int i = 0; i < 3; ++i) addMesh();
  SceneCopy copy(test::device(), scene);
  struct Frame {
    Frame(SceneCopy& copy) : renderer(test::device()), recorder(copy, {.queries = 30}) {}
    Renderer renderer;
    Recorder recorder;
    std::vector<Result> expected;
  };
  std::vector<std::unique_ptr<Frame>> frames;
  frames.reserve(3);
  for (int i = 0; i < 3; ++i) frames.push_back(std::make_unique<Frame>(copy));
  Sweeper beside(copy, {.cpuBatch = 0});
  ptrdiff_t hits = 0, drawn = 0;
  for (uint32_t number = 0; number < 90; ++number) {
    CAPTURE(number);
    Frame& frame = *frames[number % 3];
    if (number >= 3) {
      frame.renderer.wait();
      checkSame(frame.recorder.read().results, frame.expected);
      hits += std::ranges::count(frame.expected, Status::hit, &Result::status);
    }
    edit(number);
    std::vector<Query> queries(30);
    for (Query& query : queries) {
      query = {.mesh = anyMesh(), .worldFromMesh = somewhere()};
      query.direction = random.direction();
      query.distance = random.uniform(1, 20);
      query.ignoreLeaving = random.oneIn(3);
    }
    frame.expected = test::expectedOf(scene, queries);
    frame.renderer.record(frame.recorder, queries);
    frame.renderer.submit();
    if (random.oneIn(2)) edit(number);
    if (random.oneIn(3)) continue;  // the next recording uploads the changes
    const bool isSampled = random.oneIn(4);
    const Mode mode = isSampled ? Mode::sampled : Mode::contact;
    for (Query& query : queries) query.ignoreLeaving = query.ignoreLeaving && !isSampled;
    // At once, while recordings are in flight.
    const std::vector<Result> found = beside.run(queries, mode).results,
                              alone = Sweeper(test::device(), scene, {.cpuBatch = 0}).run(queries, mode).results;
    checkSame(found, alone);
    if (isSampled) drawn += std::ranges::count(alone, Status::hit, &Result::status);
  }
  for (const auto& frame : frames) frame->renderer.wait();
  CHECK(hits > 300);
  CHECK(drawn > 50);
}

TEST_CASE(
    "recorders and a sweeper share a copy that the geometry of one overwrites, all in one command buffer or later") {
  Row row(12);
  constexpr ObjectId kMoved = 4;
  row.scene.setBounds(kMoved, {{-50, -50, -50}, {50, 50, 50}});
  const Transform elsewhere = at(4.5, 0.25, 3.5);
  test::HostFrame frame;
  const HostGeometry moved = frame.move(kMoved, elsewhere).geometry();
  SceneCopy copy(test::device(), row.scene);
  Recorder first(copy), second(copy), third(copy);
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  first.record(commands, row.queries, moved);
  second.record(commands, row.queries);  // puts the object back
  submission.submitAndWait();
  const std::vector<Result> back = test::expectedOf(row.scene, row.queries);
  checkSame(second.read().results, back);
  third.record(submission.begin(), row.queries, moved);
  submission.submitAndWait();
  checkSame(Sweeper(copy, {.cpuBatch = 0}).run(row.queries).results, back);  // puts it back, too
  row.scene.setTransform(kMoved, elsewhere);
  const std::vector<Result> there = test::expectedOf(row.scene, row.queries);
  checkSame(first.read().results, there);
  CHECK_FALSE(std::ranges::equal(back, there, test::sameBits));
}

TEST_CASE("three recorders that share a scene's copy need its memory once") {
  tools::Random random(4);
  Scene scene;
  const MeshId mesh = test::addMesh(scene, tools::makeSoup(tools::Soup::plain, 30'000, random));
  scene.addObject({.mesh = mesh});
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 1};
  const Device& device = test::watchedDevice();
  SceneCopy copy(device, scene);
  const auto bytesOf = [&](auto&& make) {
    std::vector<Recorder> recorders;
    uint64_t first = 0;
    for (int i = 0; i < 3; ++i) {
      recorders.push_back(make());
      gpu::Submission submission(device.impl(), false);
      recorders.back().record(submission.begin(), {&query, 1});
      submission.submitAndWait();
      if (i == 0) first = test::allocatedDeviceBytes();
    }
    return test::allocatedDeviceBytes() - first;  // for the second and the third
  };
  constexpr Capacity kSmall{.queries = 1, .candidates = 64, .rounds = 2, .unresolvedPairs = 64};
  const uint64_t shared = bytesOf([&] { return Recorder(copy, kSmall); });
  CHECK(shared < bytesOf([&] { return Recorder(device, scene, kSmall); }) / 4);
}

TEST_CASE("after prepare() the first recording, in its place or with a shared copy, creates nothing on the device") {
  const Device& device = test::watchedDevice();
  uint32_t steps = 0;
  prepare(device, Mode::contact, [&](uint32_t done, uint32_t all, const std::string& next) {
    CHECK(done == steps++);
    CHECK(next.empty() == (done == all));
  });
  CHECK(steps > 20);
  const auto created = [] {
    uint64_t calls = 0;
    for (const char* name : {"vkAllocateMemory", "vkCreateBuffer", "vkCreateBufferView", "vkCreateShaderModule",
                             "vkCreateComputePipelines", "vkCreateDescriptorPool", "vkAllocateDescriptorSets"}) {
      calls += test::callsOf(name);
    }
    return calls;
  };
  const uint64_t before = created();
  prepare(device, Mode::contact);
  CHECK(created() == before);
  test::MovedWorld world(3, 5, {1, 4, 0}, test::always, test::never, device);
  const test::Written written(world.queries(16), device);
  const std::vector<Query>& queries = written.same;
  const HostGeometry geometry = world.geometry();
  SceneCopy copy(device, world.scene);
  constexpr Capacity kRoom{.queries = 16, .candidates = 1u << 14, .rounds = 32, .unresolvedPairs = 1u << 10};
  Recorder own(device, world.scene, kRoom), first(copy, kRoom), second(copy, kRoom);
  gpu::Submission submission(device.impl(), false);
  own.prepare(queries, geometry);
  first.prepare(queries, geometry);
  second.prepare(written, geometry);
  const uint64_t prepared = created();
  own.record(submission.begin(), queries, geometry);
  submission.submitAndWait();
  first.record(submission.begin(), queries, geometry);
  submission.submitAndWait();
  CHECK(second.read().results.empty());
  second.record(submission.begin(), written, geometry);
  submission.submitAndWait();
  CHECK(created() == prepared);
  const std::vector<Result> expected = test::expectedOf(world.truth, queries);
  for (Recorder* recorder : {&own, &first, &second}) checkSame(recorder->read().results, expected);
}

TEST_CASE("an engine without a queue records, submits nothing, and names the queue when it refuses what submits") {
  test::Host host;
  const Device hosts = host.own();
  host.handles.queue = VK_NULL_HANDLE;
  host.handles.doubles = hosts.doubles();
  const auto loud = [] { return test::callsOf("vkQueueSubmit2") + test::callsOf("vkWaitForFences"); };
  const uint64_t before = loud();
  const Device device = Device::adopt(host.handles);
  CHECK(device.doubles() == hosts.doubles());
  Row row(30);
  Recorder recorder(device, row.scene);
  Renderer renderer(hosts);
  renderer.record(recorder, row.queries);
  renderer.submitAndWait();
  const std::vector<Result> expected = Sweeper(hosts, row.scene).run(row.queries).results;
  checkSame(recorder.read().results, expected);
  for (size_t i = 0; i < expected.size(); ++i) test::checkShaderResult(renderer.shaderResult(i), expected[i]);
  CHECK_THROWS_WITH(Sweeper(device, row.scene), "HostDevice::queue is null; a Sweeper needs a queue to submit to");
  CHECK_THROWS_WITH(Pool({&device, 1}, row.scene), "HostDevice::queue is null; a Pool needs a queue to submit to");
  CHECK_THROWS_WITH(addMesh(row.scene, device, HostMesh{}),
                    "HostDevice::queue is null; addMesh of a HostMesh needs a queue to submit to");
  CHECK(loud() == before);
}
