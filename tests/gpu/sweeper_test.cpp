// Mode sampled: neither batches nor what is drawn change answers.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "gpu/device.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::add;
using test::differenceOf;

/// Counts the submissions during which another thread could submit, too. Two threads that do so would be a test, too,
/// but the layers' synchronization validation does not follow fences that several threads wait for.
class WatchedSubmits {
 public:
  explicit WatchedSubmits(Device::Impl& device) : device_(device) {
    driver = device.vk.QueueSubmit2;
    mutex = &device.queueMutex;
    submits = open = 0;
    device.vk.QueueSubmit2 = [](VkQueue queue, uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
      ++submits;
      std::thread([] {
        if (!mutex->try_lock()) return;
        ++open;
        mutex->unlock();
      }).join();
      return driver(queue, count, infos, fence);
    };
  }
  ~WatchedSubmits() { device_.vk.QueueSubmit2 = driver; }
  WatchedSubmits(const WatchedSubmits&) = delete;
  WatchedSubmits& operator=(const WatchedSubmits&) = delete;

  inline static int submits, open;

 private:
  inline static PFN_vkQueueSubmit2 driver;
  inline static std::mutex* mutex;
  Device::Impl& device_;
};

/// Counts render passes.
class CountedPasses {
 public:
  explicit CountedPasses(Device::Impl& device) : device_(device) {
    driver = device.vk.CmdBeginRenderPass;
    passes = 0;
    device.vk.CmdBeginRenderPass = [](VkCommandBuffer commands, const VkRenderPassBeginInfo* info,
                                      VkSubpassContents contents) {
      ++passes;
      driver(commands, info, contents);
    };
  }
  ~CountedPasses() { device_.vk.CmdBeginRenderPass = driver; }
  CountedPasses(const CountedPasses&) = delete;
  CountedPasses& operator=(const CountedPasses&) = delete;

  inline static int passes;

 private:
  inline static PFN_vkCmdBeginRenderPass driver;
  Device::Impl& device_;
};

}  // namespace

TEST_CASE("answers in memory that had others are those of a fresh call, in either mode and on the CPU") {
  const test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 100, .sensors = 16}), 16);
  std::vector<Query> listing = asked.queries, few(asked.queries.begin(), asked.queries.begin() + 5);
  for (Query& query : listing) query.hits = kAllHits;
  std::stop_source stopped;
  stopped.request_stop();
  Sweeper sweeper(test::device(), asked.scene, {.cpuBatch = GENERATE(0u, kNone)});
  CpuSweeper onCpu(asked.scene);
  Answers answers;
  const auto compare = [&](const Answers& fresh) {
    CHECK(differenceOf(answers, fresh) == "");
    CHECK(answers.reasons == fresh.reasons);
    CHECK(answers.stats.pairs == fresh.stats.pairs);
  };
  for (const std::vector<Query>& queries : {listing, few, asked.queries, few, listing}) {
    for (const Mode mode : {Mode::contact, Mode::sampled}) {
      if (mode == Mode::sampled && queries[0].hits > 1) continue;
      for (const std::stop_token& stop : {std::stop_token(), stopped.get_token()}) {
        sweeper.run(queries, answers, mode, stop);
        compare(sweeper.run(queries, mode, stop));
      }
    }
    onCpu.run(queries, answers);
    compare(onCpu.run(queries));
  }
}

TEST_CASE("of a batch whose stop has been requested before, a sweeper answers nothing in either mode") {
  const test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 100, .sensors = 16}), 16);
  Sweeper sweeper(test::device(), asked.scene, {.cpuBatch = GENERATE(0u, kNone)});
  for (const Mode mode : {Mode::contact, Mode::sampled}) {
    std::stop_source stop;
    const std::vector<Result> expected = sweeper.run(asked.queries, mode, stop.get_token()).results;
    stop.request_stop();
    const Answers answers = sweeper.run(asked.queries, mode, stop.get_token());
    CHECK(answers.reasons.size() == asked.queries.size());
    CHECK(answers.reasons.at(0) == "cancelled");
    CHECK(answers.stats.submissions == 0);
    CHECK(differenceOf(sweeper.run(asked.queries, mode).results, expected) == "");
  }
}

TEST_CASE("a batch of more sensors than the device has layers is split and keeps its bits") {
  test::Case asked = test::caseOf(
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 512, .shape = tools::SensorShape::box}), 16);
  Sweeper sweeper(test::device(), asked.scene);
  const std::vector<Result> once = sweeper.run(asked.queries, Mode::sampled).results;
  std::vector<Query> many;
  std::vector<Result> expected;
  for (int i = 0; i < 12; ++i) {
    many.insert(many.end(), asked.queries.begin(), asked.queries.end());
    expected.insert(expected.end(), once.begin(), once.end());
  }
  REQUIRE(many.size() > 2048);
  const Answers answers = sweeper.run(many, Mode::sampled);
  CHECK(differenceOf(answers.results, expected) == "");
  CHECK(answers.stats.submissions > 1);
}

TEST_CASE("a small budget of picture memory splits a batch and keeps its bits") {
  test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 64}), 64);
  Sweeper roomy(test::device(), asked.scene);
  Sweeper narrow(test::device(), asked.scene, {.pictureBytes = 7 * 2 * 64 * 64 * 4});
  const Answers whole = roomy.run(asked.queries, Mode::sampled), split = narrow.run(asked.queries, Mode::sampled);
  CHECK(whole.stats.submissions == 1);
  CHECK(differenceOf(split.results, whole.results) == "");
  CHECK(split.stats.submissions > 5);
}

TEST_CASE("however many threads select what is drawn, answers, reasons and submissions are the same") {
  test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 2000, .sensors = 150}), 32);
  for (const size_t i : {3u, 40u, 41u, 149u}) asked.queries[i].worldFromMesh.m[3] = 1e30;  // floats cannot hold them
  const auto answered = [&](uint32_t threads, bool select) {
    Sweeper sweeper(test::device(), asked.scene, {.select = select, .cpuThreads = threads});
    // A buffer holds all draws, or those of some six queries.
    uint32_t& limit = test::device().impl().properties.limits.maxStorageBufferRange;
    const uint32_t before = std::exchange(limit, select ? limit : 1u << 20);
    sweeper.run({&asked.queries[3], 1}, Mode::sampled);  // reads the limit, and draws nothing
    limit = before;
    return sweeper.run(asked.queries, Mode::sampled);
  };
  const uint32_t threads = GENERATE(2u, 5u);
  for (const bool select : {true, false}) {
    CAPTURE(threads, select);
    const Answers alone = answered(1, select), shared = answered(threads, select);
    CHECK(differenceOf(shared.results, alone.results) == "");
    CHECK(shared.reasons == alone.reasons);
    CHECK(alone.reasons.size() == 4);
    CHECK(shared.stats.submissions == alone.stats.submissions);
    CHECK(shared.stats.drawnObjects == alone.stats.drawnObjects);
    CHECK(shared.stats.drawnTriangles == alone.stats.drawnTriangles);
    CHECK((alone.stats.submissions > 3) == !select);
  }
}

TEST_CASE("a GPU draws in few passes, whatever the triangles, and its answers have the same bits") {
  test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 100}), 32);
  Device::Impl& device = test::device().impl();
  const auto answered = [&](VkPhysicalDeviceType type) {
    Sweeper sweeper(test::device(), asked.scene);
    const VkPhysicalDeviceType before = std::exchange(device.properties.deviceType, type);
    sweeper.run({&asked.queries[0], 1}, Mode::sampled);  // asks what the device is
    device.properties.deviceType = before;
    const CountedPasses counted(device);
    return std::pair(sweeper.run(asked.queries, Mode::sampled).results, CountedPasses::passes);
  };
  const auto [onCpu, manyPasses] = answered(VK_PHYSICAL_DEVICE_TYPE_CPU);
  const auto [onGpu, fewPasses] = answered(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
  CHECK(differenceOf(onGpu, onCpu) == "");
  CHECK(fewPasses == (device.choosesLayers ? 4 : manyPasses));  // of up to 64 layers, for R and for M
  CHECK(manyPasses > 20);
}

TEST_CASE("drawing every object gives the same bits as drawing only those in reach") {
  test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 16}), 64);
  Sweeper culled(test::device(), asked.scene);
  Sweeper naive(test::device(), asked.scene, {.select = false});
  const Answers inReach = culled.run(asked.queries, Mode::sampled), all = naive.run(asked.queries, Mode::sampled);
  CHECK(differenceOf(all.results, inReach.results) == "");
  CHECK(all.stats.drawnObjects > 100 * inReach.stats.drawnObjects);
}

TEST_CASE("drawing only the clusters in reach of one large mesh gives the same bits as drawing it whole") {
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    test::Case asked =
        test::caseOf(tools::makeWorkload(tools::OneMesh{.triangles = 50'000, .sensors = 24, .shape = shape}));
    for (size_t i = 0; i < asked.queries.size(); ++i) asked.queries[i].resolution = uint32_t(17 + i * 37 % 150);
    Sweeper culled(test::device(), asked.scene);
    Sweeper naive(test::device(), asked.scene, {.select = false});
    const Answers all = naive.run(asked.queries, Mode::sampled), inReach = culled.run(asked.queries, Mode::sampled);
    CHECK(differenceOf(inReach.results, all.results) == "");
    CHECK(5 * inReach.stats.drawnTriangles < all.stats.drawnTriangles);
    for (size_t i = 0; i < asked.queries.size(); i += 5) {
      CHECK(test::sameBits(culled.scopes(asked.queries[i]).result, all.results[i]));
    }
  }
}

TEST_CASE("the order of a batch of mixed resolutions does not change the answers") {
  test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 65}));
  for (size_t i = 0; i < asked.queries.size(); ++i) asked.queries[i].resolution = uint32_t(i * 37 % 150);
  Sweeper sweeper(test::device(), asked.scene);
  const std::vector<Result> forward = sweeper.run(asked.queries, Mode::sampled).results;
  std::reverse(asked.queries.begin(), asked.queries.end());
  std::vector<Result> backward = sweeper.run(asked.queries, Mode::sampled).results;
  std::reverse(backward.begin(), backward.end());
  CHECK(differenceOf(forward, backward) == "");
}

TEST_CASE("while a sweeper submits, no other thread can submit to the queue of its device") {
  const test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 200, .sensors = 8}), 32);
  Sweeper sweeper(test::device(), asked.scene, {.cpuBatch = 0});
  const WatchedSubmits watched(test::device().impl());
  for (const Mode mode : {Mode::contact, Mode::sampled}) sweeper.run(asked.queries, mode);
  CHECK(WatchedSubmits::submits >= 2);
  CHECK(WatchedSubmits::open == 0);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an empty batch and a query over an empty scene are answered") {
  Scene scene;
  const MeshId mesh = add(scene, tools::makeBox({1, 1, 1}));
  Sweeper sweeper(test::device(), scene);
  CHECK(sweeper.run({}).results.empty());
  const Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 5};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.status == Status::clear);
  CHECK(result.t == INFINITY);
  const Scopes scopes = sweeper.scopes(query);
  CHECK(std::isnan(scopes.R[scopes.R.size() / 2]));
  CHECK(scopes.M[scopes.M.size() / 2] == Approx(5));
}

TEST_CASE("a mesh of more triangles than a shader's loop may have iterations is drawn completely") {
  // 160,000 triangles: item lists and vertex loops run past 65,535.
  Scene scene;
  const MeshId sphere = add(scene, tools::makeUvSphere(200, 400)), cube = add(scene, tools::makeBox({0.5, 0.5, 0.5}));
  REQUIRE(scene.mesh(sphere).triangleCount() > 2 * 65'535);
  scene.addObject({sphere, {}, ~0u});
  Sweeper sweeper(test::device(), scene);
  const Query query{
      .mesh = cube, .worldFromMesh = test::at(0.1, 0.2, -5), .direction = {0, 0, 1}, .distance = 10, .resolution = 64};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.status == Status::hit);
  // The box's upper face lies at -4.75; the ball's lowest point over it at about -1.
  CHECK(result.t == Approx(3.75).margin(0.01));
}
