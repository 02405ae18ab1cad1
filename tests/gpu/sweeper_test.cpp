// Mode sampled: batches do not change answers, edits are followed, and bad queries are refused.
#include <cmath>
#include <mutex>
#include <thread>

#include "gpu/device.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

struct LoadedWorkload {
  explicit LoadedWorkload(tools::Workload w, uint32_t resolution) : workload(std::move(w)), player(workload) {
    player.show(0);
    queries = tools::queriesOf(workload.queries, resolution);
  }
  tools::Workload workload;
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

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

void checkSame(const std::vector<Result>& a, const std::vector<Result>& b) {
  REQUIRE(a.size() == b.size());
  size_t different = 0;
  for (size_t i = 0; i < a.size(); ++i) different += !test::sameBits(a[i], b[i]);
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("in mode sampled a batch of any size gives the same bits as one query at a time") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 1234}), 32);
  Sweeper sweeper(test::device(), loaded.player.scene());
  std::vector<Result> single;
  for (const Query& query : loaded.queries) single.push_back(sweeper.run({&query, 1}, Mode::sampled).results[0]);
  uint32_t found = 0;
  for (const Result& result : single) found += result.status == Status::hit;
  CHECK(found > 100);
  for (size_t size : {1, 63, 64, 65, 1234}) {
    CAPTURE(size);
    checkSame(sweeper.run(std::span(loaded.queries).first(size), Mode::sampled).results,
              {single.begin(), single.begin() + size});
  }
}

TEST_CASE("a batch of more sensors than the device has layers is split and keeps its bits") {
  LoadedWorkload loaded(
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 512, .shape = tools::SensorShape::box}), 16);
  Sweeper sweeper(test::device(), loaded.player.scene());
  const std::vector<Result> once = sweeper.run(loaded.queries, Mode::sampled).results;
  std::vector<Query> many;
  std::vector<Result> expected;
  for (int i = 0; i < 12; ++i) {
    many.insert(many.end(), loaded.queries.begin(), loaded.queries.end());
    expected.insert(expected.end(), once.begin(), once.end());
  }
  REQUIRE(many.size() > 2048);
  const Answers answers = sweeper.run(many, Mode::sampled);
  checkSame(answers.results, expected);
  CHECK(answers.stats.submissions > 1);
}

TEST_CASE("a small budget of picture memory splits a batch and keeps its bits") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 64}), 64);
  Sweeper roomy(test::device(), loaded.player.scene());
  Sweeper narrow(test::device(), loaded.player.scene(), {.pictureBytes = 7 * 2 * 64 * 64 * 4});
  const Answers whole = roomy.run(loaded.queries, Mode::sampled), split = narrow.run(loaded.queries, Mode::sampled);
  CHECK(whole.stats.submissions == 1);
  checkSame(split.results, whole.results);
  CHECK(split.stats.submissions > 5);
}

TEST_CASE("drawing every object gives the same bits as drawing only those in reach") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 16}), 64);
  Sweeper culled(test::device(), loaded.player.scene());
  Sweeper naive(test::device(), loaded.player.scene(), {.select = false});
  const Answers inReach = culled.run(loaded.queries, Mode::sampled), all = naive.run(loaded.queries, Mode::sampled);
  checkSame(all.results, inReach.results);
  CHECK(all.stats.drawnObjects > 100 * inReach.stats.drawnObjects);
}

TEST_CASE("drawing only the clusters in reach of one large mesh gives the same bits as drawing it whole") {
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    LoadedWorkload loaded(tools::makeWorkload(tools::OneMesh{.triangles = 50'000, .sensors = 24, .shape = shape}), 0);
    for (size_t i = 0; i < loaded.queries.size(); ++i) loaded.queries[i].resolution = uint32_t(17 + i * 37 % 150);
    Sweeper culled(test::device(), loaded.player.scene());
    Sweeper naive(test::device(), loaded.player.scene(), {.select = false});
    const Answers all = naive.run(loaded.queries, Mode::sampled), inReach = culled.run(loaded.queries, Mode::sampled);
    checkSame(inReach.results, all.results);
    CHECK(5 * inReach.stats.drawnTriangles < all.stats.drawnTriangles);
    for (size_t i = 0; i < loaded.queries.size(); i += 5)
      checkSame({culled.scopes(loaded.queries[i]).result}, {all.results[i]});
  }
}

TEST_CASE("the order of a batch of mixed resolutions does not change the answers") {
  LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 65}), 0);
  for (size_t i = 0; i < loaded.queries.size(); ++i) loaded.queries[i].resolution = uint32_t(i * 37 % 150);
  Sweeper sweeper(test::device(), loaded.player.scene());
  const std::vector<Result> forward = sweeper.run(loaded.queries, Mode::sampled).results;
  std::reverse(loaded.queries.begin(), loaded.queries.end());
  std::vector<Result> backward = sweeper.run(loaded.queries, Mode::sampled).results;
  std::reverse(backward.begin(), backward.end());
  checkSame(forward, backward);
}

TEST_CASE("answers follow objects that are moved, removed and added, and other ids stay valid") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  const auto at = [](double z) { return Transform{{1, 0, 0, 0.01, 0, 1, 0, 0.02, 0, 0, 1, z}}; };
  const ObjectId far = scene.addObject({mesh, at(7), ~0u});
  const ObjectId near = scene.addObject({mesh, at(4), ~0u});
  const Query query{.mesh = mesh, .direction = {0, 0, 2}, .distance = 10};
  Sweeper sweeper(test::device(), scene);
  const auto answer = [&] { return sweeper.run({&query, 1}, Mode::sampled).results[0]; };

  CHECK(answer().object == near);
  CHECK(answer().t == Approx(3).epsilon(1e-6));
  scene.setTransform(near, at(5));
  CHECK(answer().t == Approx(4).epsilon(1e-6));
  scene.removeObject(near);
  CHECK(answer().object == far);
  CHECK(answer().t == Approx(6).epsilon(1e-6));
  CHECK(scene.addObject({mesh, at(3), 2u}) == near);
  CHECK(answer().object == near);
  Query masked = query;
  masked.mask = 1;
  CHECK(sweeper.run({&masked, 1}, Mode::sampled).results[0].object == far);
  Query excluding = query;
  excluding.exclude = {near, far};
  CHECK(sweeper.run({&excluding, 1}, Mode::sampled).results[0].status == Status::clear);
  const tools::MeshData ball = tools::makeUvSphere(8, 8);
  const MeshId other = scene.addMesh(ball.positions, ball.indices);
  scene.addObject({other, at(2.5), ~0u});
  CHECK(answer().t == Approx(1).epsilon(0.05));
}

TEST_CASE("while a sweeper submits, no other thread can submit to the queue of its device") {
  const LoadedWorkload loaded(tools::makeWorkload(tools::Table1{.boxes = 200, .sensors = 8}), 32);
  Sweeper sweeper(test::device(), loaded.player.scene(), {.cpuBatch = 0});
  const WatchedSubmits watched(test::device().impl());
  for (const Mode mode : {Mode::contact, Mode::sampled}) sweeper.run(loaded.queries, mode);
  CHECK(WatchedSubmits::submits >= 2);
  CHECK(WatchedSubmits::open == 0);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an empty batch and a query over an empty scene are answered") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
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

TEST_CASE("run throws for a query that breaks its contract and names its number") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  Sweeper sweeper(test::device(), scene);
  const Query good{.mesh = mesh, .direction = {1, 0, 0}, .distance = 5};
  std::vector<Query> queries(3, good);
  queries[2].direction = {0, 0, 0};
  CHECK_THROWS_WITH(sweeper.run(queries, Mode::sampled), test::Contains("query 2") && test::Contains("direction"));
  queries[2] = good;
  queries[1].distance = -1;
  CHECK_THROWS_WITH(sweeper.run(queries, Mode::sampled), test::Contains("query 1") && test::Contains("distance"));
  queries[1] = good;
  queries[0].worldFromMesh.m = {1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0};
  CHECK_THROWS_WITH(sweeper.run(queries, Mode::sampled), test::Contains("query 0") && test::Contains("singular"));
}

TEST_CASE("a mesh of more triangles than a shader's loop may have iterations is drawn completely") {
  // 160,000 triangles: item lists and vertex loops run past 65,535.
  const tools::MeshData ball = tools::makeUvSphere(200, 400), box = tools::makeBox({0.5, 0.5, 0.5});
  REQUIRE(ball.triangleCount() > 2 * 65'535);
  Scene scene;
  const MeshId sphere = scene.addMesh(ball.positions, ball.indices), cube = scene.addMesh(box.positions, box.indices);
  scene.addObject({sphere, {}, ~0u});
  Sweeper sweeper(test::device(), scene);
  const Transform start{{1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, -5}};
  const Query query{.mesh = cube, .worldFromMesh = start, .direction = {0, 0, 1}, .distance = 10, .resolution = 64};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.status == Status::hit);
  // The box's upper face lies at -4.75; the ball's lowest point over it at about -1.
  CHECK(result.t == Approx(3.75).margin(0.01));
}
