// Recording costs a host's frames no allocation, no submission and no wait.
#include <array>

#include "embed/host.h"
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "radar/cpu_sweeper.h"
#include "radar/host.h"
#include "radar/pool.h"
#include "support/catch.h"
#include "support/resident.h"
#include "workloads/shapes.h"

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
    content.expected = sweeper.run(content.queries).results;
    all.push_back(std::move(content));
  }
  return all;
}

}  // namespace

TEST_CASE("recording 200 frames of all families allocates nothing, submits nothing and waits for nothing") {
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
    constexpr uint32_t kInFlight = 2, kFrames = 200;
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
        const std::vector<Result> read = recorder.read().results;
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
      hits += result.status == static_cast<uint32_t>(Status::hit) ||
              (result.flags == Flag::unresolved && !device.doubles());
    }
    CHECK(hits == kFrames);
    CHECK(test::counts().allocations == allocations);
  }
  CHECK(test::counts().live == 0);
}

TEST_CASE("three recorders in flight and a sweeper share one copy of a scene that moves, deforms, grows and shrinks") {
  tools::Random random(3);
  Scene scene;
  std::vector<MeshId> meshes;
  const auto addMesh = [&] {
    const tools::MeshData soup = tools::makeSoup(tools::Soup::plain, 1 + random.below(40), random);
    meshes.push_back(scene.addMesh(soup.positions, soup.indices));
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
  CpuSweeper sweeper(scene);
  size_t hits = 0, drawn = 0;
  for (uint32_t number = 0; number < 90; ++number) {
    Frame& frame = *frames[number % 3];
    if (number >= 3) {
      frame.renderer.wait();
      const std::vector<Result> read = frame.recorder.read().results;
      for (size_t i = 0; i < read.size(); ++i) {
        CAPTURE(number, i);
        REQUIRE(sameBits(read[i], frame.expected[i]));
        hits += read[i].status == Status::hit;
      }
    }
    edit(number);
    std::vector<Query> queries(30);
    for (Query& query : queries) {
      query = {.mesh = anyMesh(), .worldFromMesh = somewhere()};
      query.direction = random.direction();
      query.distance = random.uniform(1, 20);
      query.ignoreLeaving = random.oneIn(3);
    }
    frame.expected = sweeper.run(queries).results;
    for (Result& result : frame.expected) result.tier = Tier::contact;
    frame.renderer.record(frame.recorder, queries);
    frame.renderer.submit();
    if (random.oneIn(2)) edit(number);
    if (random.oneIn(3)) continue;  // the next recording uploads the changes
    const bool isSampled = random.oneIn(4);
    const Mode mode = isSampled ? Mode::sampled : Mode::contact;
    for (Query& query : queries) query.ignoreLeaving = query.ignoreLeaving && !isSampled;
    const std::vector<Result> found = beside.run(queries, mode).results,
                              alone = Sweeper(test::device(), scene, {.cpuBatch = 0}).run(queries, mode).results;
    for (size_t i = 0; i < found.size(); ++i) {
      CAPTURE(number, i);
      REQUIRE(sameBits(found[i], alone[i]));
      drawn += isSampled && found[i].status == Status::hit;
    }
  }
  for (const auto& frame : frames) frame->renderer.wait();
  CHECK(hits > 300);
  CHECK(drawn > 50);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE(
    "recorders and a sweeper share a copy that the geometry of one overwrites, all in one command buffer or later") {
  Row row(12);
  constexpr ObjectId kMoved = 4;
  row.scene.setBounds(kMoved, {{-50, -50, -50}, {50, 50, 50}});
  const Transform elsewhere{{1, 0, 0, 4.5, 0, 1, 0, 0.25, 0, 0, 1, 3.5}};
  std::vector<std::byte> bytes;
  for (const double entry : elsewhere.m) test::append(bytes, {static_cast<float>(entry)});
  const test::OnDevice transforms(bytes);
  const MovedObjects moved{.transforms = transforms.get(), .objects = {&kMoved, 1}};
  SceneCopy copy(test::device(), row.scene);
  Recorder first(copy), second(copy), third(copy);
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  first.record(commands, row.queries, {.objects = {&moved, 1}});
  second.record(commands, row.queries);  // puts the object back
  submission.submitAndWait();
  const std::vector<Result> back = CpuSweeper(row.scene).run(row.queries).results, readBack = second.read().results;
  gpu::Submission again(test::device().impl(), false);
  third.record(again.begin(), row.queries, {.objects = {&moved, 1}});
  again.submitAndWait();
  const std::vector<Result> swept = Sweeper(copy, {.cpuBatch = 0}).run(row.queries).results;  // puts it back, too
  row.scene.setTransform(kMoved, elsewhere);
  const std::vector<Result> there = CpuSweeper(row.scene).run(row.queries).results, readThere = first.read().results;
  size_t differ = 0;
  for (size_t i = 0; i < row.queries.size(); ++i) {
    CAPTURE(i);
    CHECK((readBack[i].object == back[i].object && readBack[i].t == back[i].t));
    CHECK((swept[i].object == back[i].object && swept[i].t == back[i].t));
    CHECK((readThere[i].object == there[i].object && readThere[i].t == there[i].t));
    differ += back[i].t != there[i].t;
  }
  CHECK(differ > 0);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("three recorders that share a scene's copy need its memory once", "[.long]") {
  tools::Random random(4);
  const tools::MeshData soup = tools::makeSoup(tools::Soup::plain, 300'000, random);
  Scene scene;
  const MeshId mesh = scene.addMesh(soup.positions, soup.indices);
  scene.addObject({mesh, {}});
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 1};
  const auto memoryOf = [&](auto&& make) {
    std::vector<Recorder> recorders;
    std::vector<size_t> sizes;
    for (int i = 0; i < 3; ++i) {
      recorders.push_back(make());
      gpu::Submission submission(test::device().impl(), false);
      recorders.back().record(submission.begin(), {&query, 1});
      submission.submitAndWait();
      sizes.push_back(test::residentBytes());
    }
    return sizes[2] - sizes[0];  // of the second and the third
  };
  SceneCopy copy(test::device(), scene);
  const size_t shared = memoryOf([&] { return Recorder(copy); });
  const size_t own = memoryOf([&] { return Recorder(test::device(), scene); });
  WARN("two more recorders need " << shared / 1e6 << " MB with a shared copy, " << own / 1e6 << " MB with their own");
  CHECK(shared < own / 4);
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
  const std::vector<Result> read = recorder.read().results,
                            expected = Sweeper(hosts, row.scene).run(row.queries).results;
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
