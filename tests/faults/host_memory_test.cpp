// Every allocation of host memory for edits and batches, and every start of a thread, fails in turn. The call that made
// it throws std::bad_alloc, or works all the same. Afterwards the same objects answer with the same bits, and nothing
// has leaked.
#include <array>
#include <atomic>
#include <functional>

#include "embed/host.h"
#include "faults/attempt.h"
#include "faults/scenario.h"
#include "radar/cpu_sweeper.h"
#include "scene/parallel.h"
#include "support/small_scenes.h"
#include "sweep/sweeper.h"
#include "workloads/generate.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using namespace test;

// What a scene holds, for comparison.
Answers answersOf(const Scene& scene) {
  CpuSweeper sweeper(scene, 1);
  return sweeper.run(test::contactQueries());
}

// Changes a scene to and fro, in all that a copy of it follows.
struct Changing {
  Changing() { test::SceneEdits().make(scene); }
  void change() {
    Transform pose = scene.object(4).worldFromMesh;
    pose.m[3] += isChanged ? -0.25 : 0.25;
    std::vector<float> moved(scene.mesh(2).positions.begin(), scene.mesh(2).positions.end());
    for (float& coordinate : moved) coordinate *= isChanged ? 2.0f : 0.5f;
    if (isChanged) {
      scene.removeObject(added);
      scene.removeMesh(more);
    } else {
      more = scene.addMesh(moved, scene.mesh(2).indices);
      added = scene.addObject({more, pose});
    }
    scene.setTransform(4, pose);
    scene.setPositions(2, moved);
    isChanged = !isChanged;
  }
  Scene scene;
  MeshId more = kNone;
  ObjectId added = kNone;
  bool isChanged = false;
};

}  // namespace

TEST_CASE("whichever allocation of an edit fails, the scene is as it was, and the edit can be made again") {
  using Edit = std::function<void(Scene&)>;
  const tools::MeshData triangle = test::triangle();
  std::vector<float> positions;
  const auto add = [](Scene& scene, MeshId mesh) { scene.addObject({.mesh = mesh}); };
  const std::array<double, 3> motion{1, 2, 3};
  const Bounds bounds{{-9, -9, -9}, {9, 9, 9}};
  const std::vector<std::pair<const char*, Edit>> edits{
      {"addMesh", [&](Scene& scene) { test::addMesh(scene, triangle); }},
      {"addMesh again", [&](Scene& scene) { test::addMesh(scene, triangle, bounds); }},
      {"addObject", [&](Scene& scene) { add(scene, scene.meshLimit() - 1); }},
      {"addObject again", [&](Scene& scene) { add(scene, 0); }},
      {"setPositions", [&](Scene& scene) { scene.setPositions(1, positions); }},
      {"setTransform", [](Scene& scene) { scene.setTransform(0, test::at(1, 0, 0)); }},
      {"setMotion", [&](Scene& scene) { scene.setMotion(1, motion); }},
      {"setBounds", [&](Scene& scene) { scene.setBounds(1, bounds); }},
      {"removeObject", [](Scene& scene) { scene.removeObject(scene.objectLimit() - 2); }},
      {"removeObject again", [](Scene& scene) { scene.removeObject(2); }},
      {"removeMesh", [](Scene& scene) { scene.removeMesh(scene.meshLimit() - 1); }}};
  Scene scene, reference;
  for (Scene* each : {&scene, &reference}) test::SceneEdits().make(*each);
  positions.assign(scene.mesh(1).positions.begin(), scene.mesh(1).positions.end());
  for (size_t i = 0; i < positions.size(); i += 2) positions[i] *= 3;
  CpuSweeper following(scene, 1);
  Sweeper onDevice(test::watchedDevice(), scene, {.cpuBatch = 0});
  int64_t failed = 0;
  for (const auto& edit : edits) {
    CAPTURE(edit.first);
    const auto& change = edit.second;
    const auto checkSame = [&] {
      const std::vector<Query> queries = test::contactQueries();
      const Answers expected = answersOf(reference);
      CHECK(sameBits(following.run(queries), expected));
      CHECK(sameContacts(onDevice.run(queries), expected));
    };
    failed += failEach([&](int64_t n) {
      Attempt made = attempt(Of::host, n, [&] { change(scene); });
      if (made.threw) {
        CHECK(scene.meshLimit() <= reference.meshLimit() + 1);
        checkSame();
      } else if (made.failed) {
        change(reference);  // both may be changed several times
        checkSame();
      }
      return made;
    });
    change(reference);
    checkSame();
  }
  CHECK(failed > 30);
}

TEST_CASE(
    "whichever allocation fails while the tree of a deformed mesh is built anew, the mesh has one of its shapes") {
  const tools::MeshData torus = tools::makeTorus(3, 1, 40, 30), box = tools::makeBox({1, 1, 1});
  // Every vertex goes to the place of another, so that the tree becomes bad.
  std::vector<float> scrambled;
  for (size_t i = 0, count = torus.vertexCount(); i < count; ++i) {
    const auto from = torus.positions.begin() + static_cast<ptrdiff_t>(3 * (487 * i % count));
    scrambled.insert(scrambled.end(), from, from + 3);
  }
  const std::vector<Query> queries{
      {.mesh = 1, .worldFromMesh = test::at(-9, 3, 0), .direction = {1, 0, 0}, .distance = 20},
      {.mesh = 1, .worldFromMesh = test::at(0, 0, 9), .direction = {0, 0, -1}, .distance = 20}};
  const auto make = [&](const std::vector<float>& positions) {
    Scene scene;
    scene.addMesh(positions, torus.indices);
    test::addMesh(scene, box);
    scene.addObject({.mesh = 0});
    return scene;
  };
  const auto answer = [&](const Scene& scene) { return CpuSweeper(scene, 1).run(queries); };
  const Answers before = answer(make(torus.positions)), after = answer(make(scrambled));
  REQUIRE_FALSE(sameBits(before, after));
  int64_t threw = 0, kept = 0;
  failEach([&](int64_t n) {
    Scene scene = make(torus.positions);
    const Attempt made = attempt(Of::host, n, [&] { scene.setPositions(0, scrambled); });
    (made.threw ? threw : kept) += made.failed ? 1 : 0;
    CHECK(sameBits(answer(scene), made.threw ? before : after));
    return made;
  });
  CHECK(threw > 3);
  CHECK(kept > 3);
}

TEST_CASE("whichever allocation of a batch fails, the same sweeper then answers it with the same bits") {
  Changing changing;
  CpuSweeper onCpu(changing.scene, 2);
  Sweeper onDevice(test::watchedDevice(), changing.scene, {.cpuBatch = 0});
  const test::BothModes queries;
  const auto failuresOf = [&](const auto& ask, const auto& askAnew) {
    std::array<Answers, 2> expected;  // by what the scene is then
    for (int i = 0; i < 2; ++i) {
      changing.change();
      expected.at(changing.isChanged) = askAnew();
    }
    return failEach([&](int64_t n) {
      changing.change();
      Answers found;
      Attempt made = attempt(Of::host, n, [&] { found = ask(); });
      if (made.threw) found = ask();
      CHECK(sameBits(found, expected.at(changing.isChanged)));
      return made;
    });
  };
  const auto onDeviceAnew = [&] {
    Sweeper fresh(test::watchedDevice(), changing.scene, {.cpuBatch = 0});
    return queries.answersBy(fresh);
  };
  CHECK(failuresOf([&] { return onCpu.run(queries.contact); }, [&] { return answersOf(changing.scene); }) > 20);
  CHECK(failuresOf([&] { return queries.answersBy(onDevice); }, onDeviceAnew) > 100);
}

TEST_CASE("if threads cannot be started, a parallel loop does its work on those that run") {
  for (int64_t n = 0; n < 12; ++n) {
    std::atomic<size_t> done = 0;
    Attempt made = attempt(Of::host, n, [&] {
      parallelFor(1000, 1, 4, [&](unsigned, size_t first, size_t last) { done += last - first; });
    });
    CAPTURE(n);
    if (!made.threw) CHECK(done == 1000);
  }
}

TEST_CASE("whichever allocation of a batch with lists fails, a later and shorter batch lists its own contacts only") {
  Scene scene;
  test::SceneEdits().make(scene);
  // Each begins where an object is: contacts at the start leave no order open, so the device alone lists them.
  std::vector<Query> queries = test::contactQueries(16);
  for (size_t i = 0; i < queries.size(); ++i) {
    const Object& object = scene.object(static_cast<ObjectId>(i % 8));
    queries[i] = {.mesh = object.mesh, .worldFromMesh = object.worldFromMesh, .direction = {0, 0, 1}, .distance = 1};
    queries[i].hits = kAllHits;
  }
  const std::vector<Query> later(queries.rbegin(), queries.rbegin() + 5);
  Sweeper sweeper(test::watchedDevice(), scene, {.cpuBatch = 0});
  const Answers expected = sweeper.run(later);
  const int64_t failed = failEach([&](int64_t n) {
    Attempt made = attempt(Of::host, n, [&] { sweeper.run(queries); });
    CHECK(sameBits(sweeper.run(later), expected));
    return made;
  });
  CHECK(failed > 30);
}

// But for what lists need, and pairs that only the CPU decides.
TEST_CASE("batches on the device that repeat allocate nothing") {
  const tools::Workload workload = tools::makeWorkload(tools::Table1{.boxes = 500, .sensors = 200});
  tools::ScenePlayer player(workload);
  player.show(0);
  const std::vector<Query> queries(workload.queries.begin(), workload.queries.end());
  const unsigned threads = GENERATE(1u, 2u);
  Sweeper onDevice(test::watchedDevice(), player.scene(), {.cpuBatch = 0, .cpuThreads = threads});
  CpuSweeper onCpu(player.scene(), threads);
  Answers answers;
  for (int i = 0; i < 3; ++i) onDevice.run(queries, answers);
  {
    const test::EngineWork counting;
    test::host_memory::failAt(-1);
    onDevice.run(queries, answers);
  }
  CHECK(test::host_memory::requests() == 0);
  const Answers expected = answers;
  onCpu.run(queries, answers);
  CHECK(sameContacts(answers, expected));
}

TEST_CASE("queries that are asked one by one again allocate nothing and start no thread") {
  const tools::Workload workload =
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 100, .shape = tools::SensorShape::box});
  tools::ScenePlayer player(workload);
  player.show(0);
  std::vector<Query> queries(workload.queries.begin(), workload.queries.end());
  const double clearance = GENERATE(0.0, 0.1);
  for (Query& query : queries) query.clearance = clearance;
  CpuSweeper sweeper(player.scene(), 4);
  Answers answers;
  const auto askAll = [&] {
    size_t touching = 0;
    for (const Query& query : queries) {
      sweeper.run({&query, 1}, answers);
      touching += answers.results[0].status == Status::hit;
    }
    return touching;
  };
  CHECK(askAll() > 30);
  {
    const test::EngineWork counting;
    test::host_memory::failAt(-1);
    askAll();
  }
  CHECK(test::host_memory::requests() == 0);
}
