// What a batch costs after a change of a large scene, beside the batch alone. What changes takes part in no query, so
// that all answers stay the same; the search does not know that.
#include <memory>

#include "bench/benchmarks.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/cpu_sweeper.h"
#include "workloads/generate.h"
#include "workloads/shapes.h"

namespace radar::bench {

namespace {

/// A scene of many boxes, and what is changed in it.
struct Town {
  explicit Town(const tools::Workload& workload) {
    tools::replaceBy(workload, 0, scene);
    house = addMesh();
    moved = add(0);
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      objects.push_back(id);
      transforms.push_back(scene.object(id).worldFromMesh);
    }
  }

  MeshId addMesh() {
    const tools::MeshData box = tools::makeBox({1, 1, 1});
    return scene.addMesh(box.positions, box.indices);
  }
  ObjectId add(double x) {
    return scene.addObject({.mesh = house, .worldFromMesh = {{1, 0, 0, x, 0, 1, 0, 2, 0, 0, 1, 3}}, .mask = 0});
  }
  void moveOne() { scene.setTransform(moved, {{1, 0, 0, ++place, 0, 1, 0, 2, 0, 0, 1, 3}}); }
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
  /// To where they are: every pose counts as changed.
  void moveAll() { scene.setTransforms(objects, transforms); }

  Scene scene;
  MeshId house = kNone, another = kNone;
  ObjectId moved = kNone, added = kNone;
  std::vector<ObjectId> objects;  // all but `added`
  std::vector<Transform> transforms;
  double place = 0;
};

template <class Searcher>
void addMethods(std::vector<Method>& methods, const std::string& where, Town& town, Searcher& searcher) {
  const auto answer = [&searcher](std::span<const Query> queries) { return searcher.run(queries).results; };
  const auto add = [&](const char* name, auto change) {
    methods.push_back({where + name, answer, [&town, &searcher, change](uint32_t) {
                         change(town);
                         searcher.sync();
                       }});
  };
  methods.push_back({where + ", the batch alone", answer});
  add(", one object moved", [](Town& t) { t.moveOne(); });
  add(", one object added or removed", [](Town& t) { t.addOrRemoveOne(); });
  add(", a mesh exchanged", [](Town& t) { t.exchangeMesh(); });
  add(", all objects moved", [](Town& t) { t.moveAll(); });
}

void run(uint32_t boxes, int& status) {
  const Device device = Device::open();
  const tools::Workload workload =
      tools::makeWorkload(tools::Scale{.boxes = boxes, .sensors = 64, .shape = tools::SensorShape::box});
  Town onDevice(workload), onCpu(workload);
  Sweeper sweeper(device, onDevice.scene, {.cpuBatch = 0});
  CpuSweeper cpu(onCpu.scene);
  std::vector<Method> methods;
  addMethods(methods, "device", onDevice, sweeper);
  // What no change of all poses can do without.
  const VkDeviceSize bytes = VkDeviceSize{boxes} * sizeof(Transform);
  const std::vector<std::byte> poses(bytes);
  gpu::Buffer there(device.impl(), "poses", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  there.reserve(bytes);
  gpu::Upload upload(device.impl());
  gpu::Submission submission(device.impl(), false);
  methods.push_back({"device, all poses copied there", methods[0].answer, [&](uint32_t) {
                       upload.begin();
                       upload.add(poses.data(), bytes, there);
                       upload.record(submission.begin());
                       submission.submitAndWait();
                     }});
  addMethods(methods, "CPU", onCpu, cpu);
  const std::vector<Batch> batches = tools::batchesOf(workload.queries);
  printRows("changes-" + std::to_string(boxes), methods, {&batches.front(), 1}, {.least = 9, .most = 9}, status);
}

}  // namespace

void addChanges(CLI::App& app, int& status) {
  auto sizes = std::make_shared<std::vector<uint32_t>>(std::vector<uint32_t>{10'000, 100'000, 1'000'000});
  CLI::App* command = app.add_subcommand("changes", "A batch of 64 after a change of the scene: prepare is the change");
  command->add_option("--boxes", *sizes, "Objects in the scene")
      ->check(CLI::Range(1u, 10'000'000u))
      ->capture_default_str();
  command->callback([sizes, &status] {
    const Device device = Device::open();
    printHead({&device, 1});
    for (const uint32_t boxes : *sizes) run(boxes, status);
  });
}

}  // namespace radar::bench
