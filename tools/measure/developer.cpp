#include "measure/developer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "measure/timing.h"
#include "radar/cpu_sweeper.h"
#include "radar/recorder.h"
#include "scene/scene.h"
#include "workloads/drop_cutter.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace radar::tools {

namespace {

// Of small batches many, each its own, so that no one query stands for all.
Workload inBatches(Workload workload, uint32_t size) {
  const size_t enough = size == 1 ? 48 : size < 64 ? 8 : 1;
  workload.queries.resize(std::min(enough * size, workload.queries.size() / size * size));
  for (size_t i = 0; i < workload.queries.size(); ++i) workload.queries[i].batch = i / size;
  return workload;
}

// Times of sessions that answer one batch, in turns, each against the first's. They change something when they show.
void addRows(Json& report, const char* part, const std::string& workload, const std::vector<Session>& sessions,
             const Batch& batch, Extent extent) {
  const uint32_t passes = extent == Extent::full ? 9 : 1;
  const std::vector<Series> all = measure(sessions, {&batch, 1}, {.least = passes, .most = passes});
  Json& rows = partOf(report, part, std::string("Section ") + part + ", microseconds")["rows"];
  double first = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    const double change = 1e6 * median(secondsOf(all[i].show)), answer = 1e6 * median(secondsOf(all[i].answer));
    if (i == 0) first = change + answer;
    rows.push_back({{"workload", workload},
                    {"after", sessions[i].name},
                    {"change_us", change},
                    {"batch_us", answer},
                    {"times_the_first", (change + answer) / first},
                    {"differ", all[i].differ}});
  }
  partOf(report, part)["state"] = "done";
}

// A scene of many boxes, and what is changed in it.
struct Town {
  explicit Town(const Workload& workload) {
    replaceBy(workload, 0, scene);
    house = addMesh();
    moved = add(0);
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      objects.push_back(id);
      transforms.push_back(scene.object(id).worldFromMesh);
    }
  }

  MeshId addMesh() {
    const MeshData box = makeBox({1, 1, 1});
    return scene.addMesh(box.positions, box.indices);
  }
  ObjectId add(double x) { return scene.addObject({.mesh = house, .worldFromMesh = placedAt({x, 2, 3}), .mask = 0}); }
  void moveOne() { scene.setTransform(moved, placedAt({++place, 2, 3})); }
  void addOrRemoveOne() {
    if (added == kNone) {
      added = add(++place);
    } else {
      scene.removeObject(std::exchange(added, kNone));
    }
  }
  void exchangeMesh() {
    if (another != kNone) scene.removeMesh(another);
    another = addMesh();
  }
  // To where they are: every pose counts as changed.
  void moveAll() { scene.setTransforms(objects, transforms); }

  Scene scene;
  MeshId house = kNone, another = kNone;
  ObjectId moved = kNone, added = kNone;
  std::vector<ObjectId> objects;  // all but `added`
  std::vector<Transform> transforms;
  double place = 0;
};

template <class Searcher>
Session sessionOf(const std::string& name, Searcher& searcher, const std::function<void()>& change) {
  return {name, [&](std::span<const Query> queries) { return resultsOf(searcher.run(queries)); },
          [&, change](uint32_t) {
            change();
            searcher.sync();
          }};
}

template <class Searcher>
std::vector<Session> townSessions(Town& town, Searcher& searcher) {
  std::vector<Session> sessions{sessionOf("nothing", searcher, [] {})};
  const auto add = [&](const char* name, void (Town::*change)()) {
    sessions.push_back(sessionOf(name, searcher, [&town, change] { (town.*change)(); }));
  };
  add("one object moved", &Town::moveOne);
  add("one object added or removed", &Town::addOrRemoveOne);
  add("a mesh exchanged", &Town::exchangeMesh);
  add("all objects moved", &Town::moveAll);
  return sessions;
}

void editTown(const Device& device, uint32_t boxes, Extent extent, Json& report) {
  const Workload workload = makeWorkload(Scale{.boxes = boxes, .sensors = 64, .shape = SensorShape::box});
  const Batch batch = batchesOf(workload.queries).front();
  const std::string name = std::to_string(boxes) + " boxes, ";
  Town town(workload);
  {
    Sweeper sweeper(device, town.scene, {.cpuBatch = 0});
    std::vector<Session> sessions = townSessions(town, sweeper);
    // What no change of all poses can do without.
    const VkDeviceSize bytes = VkDeviceSize{boxes} * sizeof(Transform);
    const std::vector<std::byte> poses(bytes);
    gpu::Buffer there(device.impl(), "poses", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    there.reserve(bytes);
    gpu::Upload upload(device.impl());
    gpu::Submission submission(device.impl(), false);
    sessions.push_back({"all poses copied there", sessions[0].answer, [&](uint32_t) {
                          upload.begin();
                          upload.add(poses.data(), bytes, there);
                          upload.record(submission.begin());
                          submission.submitAndWait();
                        }});
    addRows(report, "edits", name + "device", sessions, batch, extent);
  }
  CpuSweeper cpu(town.scene);
  addRows(report, "edits", name + "CPU", townSessions(town, cpu), batch, extent);
}

// A scene with a sphere that has waves of two shapes in turn.
struct Sea {
  Sea() : sphere(makeUvSphere(225, 224)) {
    for (int shape = 0; shape < 2; ++shape) {
      std::vector<float>& positions = shapes.emplace_back(sphere.positions);
      for (size_t i = 0; i < positions.size(); i += 3) {
        const double wave = 1 + 0.05 * std::sin(9.0 * sphere.positions[i] + 7.0 * sphere.positions[i + 1] + shape);
        for (size_t k = i; k < i + 3; ++k) positions[k] = static_cast<float>(wave * sphere.positions[k]);
      }
    }
    const MeshData box = makeBox({0.05, 0.05, 0.05});
    sensor = scene.addMesh(box.positions, box.indices);
    add();
  }
  void add() {
    mesh = scene.addMesh(shapes[step % 2], sphere.indices);
    object = scene.addObject({.mesh = mesh});
  }
  void refit() { scene.setPositions(mesh, shapes[++step % 2]); }
  void rebuild() {
    ++step;
    scene.removeObject(object);
    scene.removeMesh(mesh);
    add();
  }

  MeshData sphere;
  std::vector<std::vector<float>> shapes;
  Scene scene;
  MeshId sensor = kNone, mesh = kNone;
  ObjectId object = kNone;
  size_t step = 0;
};

void editSea(const Device& device, Extent extent, Json& report) {
  Sea refitted, rebuilt, onDevice;
  CpuSweeper cpu(refitted.scene), cpuRebuilt(rebuilt.scene);
  Sweeper sweeper(device, onDevice.scene, {.cpuBatch = 0});
  Batch batch;
  Random random(1);
  for (int i = 0; i < 64; ++i) {
    const Vec3 from = 3.0 * random.direction(), to = random.inCube(0.5);
    batch.queries.push_back(
        {.mesh = refitted.sensor, .worldFromMesh = placedAt(from), .direction = to - from, .distance = 4});
  }
  addRows(report, "edits", "a mesh of 100,352 triangles that deforms",
          {sessionOf("CPU, tree refitted", cpu, [&] { refitted.refit(); }),
           sessionOf("CPU, tree built anew", cpuRebuilt, [&] { rebuilt.rebuild(); }),
           sessionOf("device, tree refitted", sweeper, [&] { onDevice.refit(); })},
          batch, extent);
}

constexpr Capacity kCapacity{.queries = 64, .candidates = 1u << 16, .unresolvedPairs = 1u << 14};

// Records what `before` and the recorder record; answers by executing that.
Session recording(
    const std::string& name, gpu::Submission& submission, Recorder& recorder, const Batch& batch,
    const HostGeometry& geometry,
    const std::function<void(const gpu::Commands&)>& before = [](const gpu::Commands&) {}) {
  return {name,
          [&](std::span<const Query>) {
            submission.submitAndWait();
            return recorder.read().results;
          },
          [&, geometry, before](uint32_t) {
            const gpu::Commands commands = submission.begin();
            before(commands);
            recorder.record(commands, batch.queries, geometry);
          }};
}

// What a host has on its device.
struct HostData {
  HostData(const Device& device, const std::vector<float>& values)
      : buffer(device.impl(), "host's", gpu::BufferDomain::device,
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
    buffer.reserve(gpu::bytesOf(values));
    gpu::Upload upload(device.impl());
    gpu::Submission submission(device.impl(), false);
    upload.begin();
    upload.add(values.data(), gpu::bytesOf(values), buffer);
    upload.record(submission.begin());
    submission.submitAndWait();
  }
  gpu::Buffer buffer;
};

// Moves all boxes of a scene, to where they are, so that the answers are the same. In the last row the scene has each
// in another's place: the worst tree.
void moveAll(const Device& device, uint32_t boxes, Extent extent, Json& report) {
  Workload workload = makeWorkload(Scale{.boxes = boxes, .sensors = 64, .shape = SensorShape::box});
  std::vector<Instance>& instances = workload.scenes[0].instances;
  std::vector<float> rows;
  for (Instance& instance : instances) {
    for (double& value : instance.worldFromMesh.m) {
      rows.push_back(static_cast<float>(value = static_cast<float>(value)));
    }
  }
  const VkDeviceSize bytes = gpu::bytesOf(rows);
  const HostData transforms(device, rows);
  gpu::Buffer copied(device.impl(), "copied transforms", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  copied.reserve(bytes);
  Scene standing, moving, exchanged;
  replaceBy(workload, 0, standing);
  replaceBy(workload, 0, moving);
  Random random(3);
  for (size_t i = instances.size(); i-- > 1;) {
    std::swap(instances[i].worldFromMesh, instances[random.below(static_cast<uint32_t>(i) + 1)].worldFromMesh);
  }
  replaceBy(workload, 0, exchanged);
  const MovedObjects moved{.transforms = transforms.buffer.get(), .count = static_cast<uint32_t>(instances.size())};
  Recorder still(device, standing, kCapacity), all(device, moving, kCapacity), far(device, exchanged, kCapacity);
  gpu::Submission submission(device.impl(), false);
  const Batch batch = batchesOf(workload.queries).front();
  const auto copy = [&](const gpu::Commands& commands) {
    const VkBufferCopy region{0, 0, bytes};
    commands->CmdCopyBuffer(commands, transforms.buffer.get(), copied.get(), 1, &region);
  };
  addRows(report, "recorded", std::to_string(boxes) + " boxes",
          {recording("nothing", submission, still, batch, {}),
           recording("all transforms copied", submission, still, batch, {}, copy),
           recording("all moved", submission, all, batch, {.objects = {&moved, 1}}),
           recording("all moved, from each other's places", submission, far, batch, {.objects = {&moved, 1}})},
          batch, extent);
}

// Figure 7 as it stands, and as a host has it that moves and deforms the teapots: their bounds with a tenth to spare.
struct Flight {
  Flight() : batch(batchesOf(workload.queries).front()), teapot(batch.queries[0].mesh) {
    replaceBy(workload, batch.scene, standing);
    replaceBy(workload, batch.scene, moving);
    for (ObjectId id = 0; id < standing.objectLimit(); ++id) {
      Object object = standing.object(id);
      if (object.mesh != teapot) continue;
      for (double& value : object.worldFromMesh.m) value = static_cast<float>(value);
      standing.setTransform(id, object.worldFromMesh);
      teapots.push_back(id);
    }
    show();
  }

  // Anew: as a host does whose vertices pass through the CPU.
  void show() {
    for (const ObjectId id : teapots) moving.removeObject(id);
    moving.removeMesh(teapot);
    moving.addMesh(mesh().positions, mesh().indices, widened(boxOf(standing.impl().meshes[teapot], Transform{}.m)));
    for (const ObjectId id : teapots) {
      moving.addObject(standing.object(id));
      moving.setBounds(id, widened(boxOf(moving.impl().meshes[teapot], standing.object(id).worldFromMesh.m)));
    }
  }

  const MeshData& mesh() const { return workload.meshes[teapot]; }

  static radar::Bounds widened(const Box& box) {
    radar::Bounds bounds{box.lo, box.hi};
    for (size_t k = 0; k < 3; ++k) {
      const double room = 0.1 * (box.hi[k] - box.lo[k]);
      bounds.lo[k] -= room;
      bounds.hi[k] += room;
    }
    return bounds;
  }

  Workload workload = makeWorkload(Figure7{.teapots = 30, .steps = 1});
  Batch batch;
  MeshId teapot;
  std::vector<ObjectId> teapots;
  Scene standing, moving;
};

void fly(const Device& device, Extent extent, Json& report) {
  Flight flight;
  // The vertices and the transforms as they are, so that the answers are the same.
  std::vector<float> words = flight.mesh().positions;
  const size_t transforms = sizeof(float) * words.size();
  for (const ObjectId id : flight.teapots) {
    for (const double value : flight.standing.object(id).worldFromMesh.m) words.push_back(static_cast<float>(value));
  }
  const HostData there(device, words);
  const DeformedMesh deformed{flight.teapot, {.buffer = there.buffer.get()}};
  const MovedObjects moved{.transforms = there.buffer.get(), .first = transforms, .objects = flight.teapots};
  Recorder standing(device, flight.standing, kCapacity), moving(device, flight.moving, kCapacity),
      unbounded(device, flight.standing, kCapacity);
  gpu::Submission submission(device.impl(), false);
  const auto session = [&](const char* name, Recorder& recorder, const HostGeometry& geometry) {
    return recording(name, submission, recorder, flight.batch, geometry);
  };
  addRows(report, "recorded", "30 teapots",
          {session("nothing", standing, {}), session("moved", moving, {.objects = {&moved, 1}}),
           session("deformed", moving, {.meshes = {&deformed, 1}}),
           session("deformed, without bounds", unbounded, {.meshes = {&deformed, 1}}),
           session("moved and deformed", moving, {.meshes = {&deformed, 1}, .objects = {&moved, 1}}),
           session("moved and deformed, without bounds", unbounded, {.meshes = {&deformed, 1}, .objects = {&moved, 1}}),
           recording("deformed by the CPU", submission, moving, flight.batch, {},
                     [&](const gpu::Commands&) { flight.show(); })},
          flight.batch, extent);
}

}  // namespace

std::vector<Case> searchCases(Extent extent) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const std::vector<uint32_t>& sizes,
                       const std::function<Workload(uint32_t)>& make) {
    for (const uint32_t size : sizes) {
      if (extent != Extent::full && size > 1'024) continue;
      cases.push_back({"search", name, name, "queries in a batch", static_cast<double>(size),
                       [=] { return inBatches(make(std::max(size, 64u)), size); }});
    }
  };
  const std::vector<uint32_t> sizes{1, 64, 1'024, 16'384, 131'072}, fewer{1, 64, 1'024, 16'384}, heavy{1, 64, 256};
  add("table1-boxes", sizes,
      [](uint32_t n) { return makeWorkload(Table1{.boxes = 30'000, .sensors = n, .shape = SensorShape::box}); });
  add("table1-teapots", sizes, [](uint32_t n) { return makeWorkload(Table1{.boxes = 30'000, .sensors = n}); });
  for (const uint32_t triangles : {1'000'000u, 10'000'000u}) {
    if (extent != Extent::full && triangles > 1'000'000) continue;
    add("mesh-" + std::to_string(triangles) + "-boxes", fewer, [=](uint32_t n) {
      return makeWorkload(OneMesh{.triangles = triangles, .sensors = n, .shape = SensorShape::box});
    });
  }
  add("city-teapots", fewer, [](uint32_t n) { return makeWorkload(OneMesh{.sensors = n}); });
  for (const Interlocking kind : kInterlocking) {
    std::string name = std::string("interlocking-") + nameOf(kind);
    std::replace(name.begin(), name.end(), ' ', '-');
    add(name, heavy, [=](uint32_t n) { return makeWorkload(InterlockingPairs{.kind = kind, .sensors = n}); });
  }
  for (const uint32_t boxes : {1'000u, 1'000'000u}) {
    add("boxes-" + std::to_string(boxes), {16'384},
        [=](uint32_t n) { return makeWorkload(Scale{.boxes = boxes, .sensors = n, .shape = SensorShape::box}); });
  }
  add("drop-cutter", {1, 64, 1'024, 42'000}, [](uint32_t) { return makeWorkload(DropCutter()); });
  return cases;
}

std::vector<Case> contactCases(Extent extent) {
  std::vector<Case> cases;
  const uint32_t sensors = extent == Extent::full ? 1'024 : 64;
  const auto add = [&](const std::string& name, const std::function<Workload()>& make) {
    const auto addKind = [&](const std::string& kind, const std::function<void(Query&)>& change) {
      cases.push_back({"contacts", name + kind, name + kind, "queries", static_cast<double>(sensors), [=] {
                         Workload workload = make();
                         for (QuerySpec& query : workload.queries) change(query);
                         return workload;
                       }});
    };
    addKind("", [](Query&) {});
    addKind("-leaving-ignored", [](Query& query) { query.ignoreLeaving = true; });
    addKind("-all-hits", [](Query& query) { query.hits = kAllHits; });
  };
  add("boxes", [=] { return makeWorkload(Table1{.boxes = 30'000, .sensors = sensors, .shape = SensorShape::box}); });
  add("teapots", [=] { return makeWorkload(Table1{.boxes = 30'000, .sensors = sensors}); });
  add("ring-on-peg",
      [=] { return makeWorkload(InterlockingPairs{.kind = Interlocking::ringOnPeg, .sensors = sensors}); });
  add("comb-in-comb",
      [=] { return makeWorkload(InterlockingPairs{.kind = Interlocking::combInComb, .sensors = sensors}); });
  return cases;
}

void measureEdits(const Device& device, Extent extent, Json& report) {
  const std::vector<uint32_t> full{10'000, 100'000, 1'000'000}, few{1'000};
  for (const uint32_t boxes : extent == Extent::full ? full : few) editTown(device, boxes, extent, report);
  editSea(device, extent, report);
}

void measureRecorded(const Device& device, Extent extent, Json& report) {
  fly(device, extent, report);
  const std::vector<uint32_t> full{10'000, 600'000}, few{1'000};
  for (const uint32_t boxes : extent == Extent::full ? full : few) moveAll(device, boxes, extent, report);
}

}  // namespace radar::tools
