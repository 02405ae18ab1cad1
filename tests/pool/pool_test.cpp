#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "pool/fixture.h"
#include "support/catch.h"

using namespace radar;
using namespace test;

namespace {

std::multiset<std::string> threadNames() {
  std::multiset<std::string> names;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::ifstream comm(task.path() / "comm");
    std::getline(comm, name);
    names.insert(name);
  }
  return names;
}

}  // namespace

TEST_CASE("a pool of one or two devices gives the bits of a plain sweeper for 10,000 random queries of both modes") {
  const Mode mode = GENERATE(Mode::contact, Mode::sampled);
  const Boxes boxes(mode == Mode::contact ? 6'667 : 3'333);
  const std::vector<Result> expected = boxes.answers(mode);
  CHECK(std::ranges::count(expected, Status::hit, &Result::status) > ptrdiff_t(expected.size()) / 20);
  for (const size_t count : {1, 2}) {
    CAPTURE(count);
    Pool pool(twoDevices().first(count), boxes.player.scene(), test::kOnDevice);
    const PoolAnswers answers = pool.submit(boxes.queries, mode).get();
    CHECK(differences(answers.results, expected) == 0);
    CHECK(answers.reasons.empty());
    CHECK(answers.retired.empty());
    uint64_t queries = 0;
    for (const PoolDevice& device : pool.devices()) {
      CHECK(device.queries > 0);
      queries += device.queries;
    }
    CHECK(queries == boxes.queries.size());
  }
}

TEST_CASE("the chunks of a batch add up to its queries, and their times are in order") {
  const Boxes boxes(200);
  Pool pool(twoDevices(), boxes.player.scene(), {.timestamps = true, .cpuBatch = 0});
  const PoolAnswers answers = pool.submit(boxes.queries).get();
  uint32_t queries = 0;
  for (const ChunkTrace& chunk : answers.chunks) {
    queries += chunk.queries;
    CHECK(chunk.device < 2);
    CHECK(answers.submitted <= chunk.begun);
    CHECK(chunk.begun <= chunk.submitted);
    CHECK(chunk.submitted <= chunk.awaited);
    CHECK(chunk.submitted <= chunk.done);
    CHECK(chunk.done <= chunk.decoded);
    CHECK(chunk.decoded <= answers.answered);
    CHECK_FALSE(chunk.stages.empty());
  }
  CHECK(queries == 200);
  CHECK(answers.stats.pairs > 0);
}

TEST_CASE("an edit waits for earlier batches and reaches every device") {
  Boxes boxes(64);
  const Query query = boxes.queries[0];
  Scene scene;
  const tools::MeshData& mesh = boxes.workload.meshes[query.mesh];
  const MeshId id = scene.addMesh(mesh.positions, mesh.indices);
  const auto at = [](double z) { return Transform{{1, 0, 0, 0.01, 0, 1, 0, 0.02, 0, 0, 1, z}}; };
  const ObjectId object = scene.addObject({id, at(100), ~0u});
  const std::vector<Query> many(64, Query{.mesh = id, .direction = {0, 0, 1}, .distance = 200});
  Pool pool(twoDevices(), scene, test::kOnDevice);
  std::vector<std::future<PoolAnswers>> futures;
  for (int step = 0; step < 20; ++step) {
    futures.push_back(pool.submit(many));
    pool.edit([&] { scene.setTransform(object, at(100 - step - 1)); });
  }
  double before = 0;
  for (auto& future : futures) {
    const PoolAnswers answers = future.get();
    for (const Result& result : answers.results) CHECK(result.t == answers.results[0].t);
    if (before != 0) CHECK(answers.results[0].t == Approx(before - 1));
    before = answers.results[0].t;
  }
  ObjectId added = kNone;
  pool.edit([&] { added = scene.addObject({id, at(50), ~0u}); });
  for (const Result& result : pool.submit(many).get().results) CHECK(result.object == added);
}

TEST_CASE("the exception of an edit reaches the caller, and the pool stays usable") {
  const Boxes boxes(16);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  CHECK_THROWS_AS(pool.edit([] { throw std::runtime_error("no"); }), std::runtime_error);
  CHECK(differences(pool.submit(boxes.queries).get().results, boxes.answers()) == 0);
}

TEST_CASE("threads that submit and edit concurrently get their own answers") {
  const Boxes boxes(96);
  const std::vector<Result> contact = boxes.answers(), sampled = boxes.answers(Mode::sampled);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  std::atomic<size_t> wrong = 0;
  std::vector<std::thread> threads;
  for (size_t t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (size_t round = 0; round < 10; ++round) {
        const size_t first = (13 * t + 7 * round) % 64, count = 1 + (t + round) % 32;
        std::vector<Query> part(boxes.queries.begin() + first, boxes.queries.begin() + first + count);
        const bool isSampled = (t + round) % 3 == 0;
        const PoolAnswers answers = pool.submit(std::move(part), isSampled ? Mode::sampled : Mode::contact).get();
        wrong += differences(answers.results, std::span(isSampled ? sampled : contact).subspan(first, count));
        if (t < 2) pool.edit([] {});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("submit throws for a query that breaks its contract, names it and starts nothing of its batch") {
  const Boxes boxes(8);
  Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
  CHECK(pool.submit({}).get().results.empty());
  std::vector<Query> queries = boxes.queries;
  queries[5].direction = {};
  CHECK_THROWS_WITH(pool.submit(queries), test::Contains("query 5"));
  bool isEdited = false;
  pool.edit([&] { isEdited = true; });  // does not wait for the batch that was refused
  CHECK(isEdited);
  CHECK(pool.devices()[0].queries + pool.devices()[1].queries == 0);
}

TEST_CASE("a pool runs one named thread per device and ends them when it is destroyed") {
  const Boxes boxes(8);
  // On first use a driver starts threads of its own, which inherit the name of the thread that starts them.
  Pool(twoDevices(), boxes.player.scene()).submit(boxes.queries).wait();
  std::multiset<std::string> expected = threadNames();
  const std::multiset<std::string> before = expected;
  expected.insert({"radar-device-0", "radar-device-1"});
  {
    Pool pool(twoDevices(), boxes.player.scene(), test::kOnDevice);
    pool.submit(boxes.queries).wait();
    CHECK(threadNames() == expected);
  }
  CHECK(threadNames() == before);
}

TEST_CASE("openDevices refuses unknown and repeated numbers, and a pool refuses two devices with one queue") {
  const uint32_t twice[] = {1, 1}, missing[] = {0, 7};
  CHECK_THROWS_WITH(openDevices(twice), test::Contains("device 1 is named twice"));
  CHECK_THROWS_WITH(openDevices(missing), test::Contains("device 7 does not exist"));
  CHECK(twoDevices()[0].handles().physicalDevice != twoDevices()[1].handles().physicalDevice);
  const Scene scene;
  CHECK_THROWS_WITH(Pool({}, scene), test::Contains("at least one device"));
  std::vector<Device> same;
  same.reserve(2);
  for (int i = 0; i < 2; ++i) same.push_back(Device::adopt(twoDevices()[0].handles()));
  CHECK_THROWS_WITH(Pool(same, scene), test::Contains("devices 0 and 1 share a queue"));
}
