// What a frame costs whose searches are recorded into a host's command buffer: of a scene that stands, one whose
// objects the host moves, one whose mesh it deforms, on its device; and of one whose mesh passes through the CPU. The
// teapots of Figure 7 among their boxes; and a large scene in which the host moves everything.
#include <cstring>
#include <memory>
#include <numeric>

#include "bench/benchmarks.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "scene/scene.h"
#include "workloads/generate.h"
#include "workloads/random.h"

namespace radar::bench {

namespace {

constexpr Capacity kCapacity{.queries = 64, .candidates = 1u << 16, .unresolvedPairs = 1u << 14};

/// Figure 7 as it stands, and as a host has it that moves and deforms the teapots: their bounds with a tenth to spare.
struct Flight {
  Flight()
      : workload(tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1})),
        batch(tools::batchesOf(workload.queries).front()),
        teapot(batch.queries[0].mesh) {
    tools::replaceBy(workload, batch.scene, standing);
    tools::replaceBy(workload, batch.scene, moving);
    for (ObjectId id = 0; id < standing.objectLimit(); ++id) {
      Object object = standing.object(id);
      if (object.mesh != teapot) continue;
      for (double& value : object.worldFromMesh.m) value = static_cast<float>(value);
      standing.setTransform(id, object.worldFromMesh);
      teapots.push_back(id);
    }
    show();
  }

  /// Anew: as a host does whose vertices pass through the CPU.
  void show() {
    for (const ObjectId id : teapots) moving.removeObject(id);
    moving.removeMesh(teapot);
    const Box box = boxOf(standing.impl().meshes[teapot], Transform{}.m);
    moving.addMesh(mesh().positions, mesh().indices, widened(box));
    for (const ObjectId id : teapots) {
      moving.addObject(standing.object(id));
      moving.setBounds(id, widened(boxOf(moving.impl().meshes[teapot], standing.object(id).worldFromMesh.m)));
    }
  }

  const tools::MeshData& mesh() const { return workload.meshes[teapot]; }

  static Bounds widened(const Box& box) {
    Bounds bounds{box.lo, box.hi};
    for (size_t k = 0; k < 3; ++k) {
      const double room = 0.1 * (box.hi[k] - box.lo[k]);
      bounds.lo[k] -= room;
      bounds.hi[k] += room;
    }
    return bounds;
  }

  tools::Workload workload;
  Batch batch;
  MeshId teapot;
  std::vector<ObjectId> teapots;
  Scene standing, moving;
};

/// Moves all boxes of a scene, to where they are, so that the answers are the same. In the last row the scene has each
/// in another's place: the worst tree.
void runAllMoved(const Device& device, uint32_t boxes, int& status) {
  tools::Workload workload =
      tools::makeWorkload(tools::Scale{.boxes = boxes, .sensors = 64, .shape = tools::SensorShape::box});
  std::vector<float> rows;
  for (tools::Instance& instance : workload.scenes[0].instances) {
    for (double& value : instance.worldFromMesh.m)
      rows.push_back(static_cast<float>(value = static_cast<float>(value)));
  }
  const VkDeviceSize bytes = gpu::bytesOf(rows);
  gpu::Buffer transforms(device.impl(), "transforms", gpu::BufferDomain::device,
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      copied(device.impl(), "copied transforms", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  gpu::Submission submission(device.impl(), false);
  transforms.reserve(bytes);
  copied.reserve(bytes);
  {
    gpu::Upload upload(device.impl());
    upload.begin();
    upload.add(rows.data(), bytes, transforms);
    upload.record(submission.begin());
    submission.submitAndWait();
  }
  Scene standing, moving, exchanged;
  tools::replaceBy(workload, 0, standing);
  tools::replaceBy(workload, 0, moving);
  std::vector<tools::Instance>& instances = workload.scenes[0].instances;
  tools::Random random(3);
  for (size_t i = instances.size(); i-- > 1;) {
    std::swap(instances[i].worldFromMesh, instances[random.below(static_cast<uint32_t>(i) + 1)].worldFromMesh);
  }
  tools::replaceBy(workload, 0, exchanged);
  std::vector<ObjectId> objects(rows.size() / 12);
  std::iota(objects.begin(), objects.end(), 0);
  const MovedObjects moved{.transforms = transforms.get(), .objects = objects};
  Recorder still(device, standing, kCapacity), all(device, moving, kCapacity), far(device, exchanged, kCapacity);
  const std::vector<Batch> batches = tools::batchesOf(workload.queries);
  const auto method = [&](const char* name, Recorder& recorder, bool copies, HostGeometry geometry) {
    return Method{name,
                  [&](auto) {
                    submission.submitAndWait();
                    return recorder.read().results;
                  },
                  [&, geometry, copies](uint32_t) {
                    const gpu::Commands commands = submission.begin();
                    const VkBufferCopy region{0, 0, bytes};
                    if (copies) commands->CmdCopyBuffer(commands, transforms.get(), copied.get(), 1, &region);
                    recorder.record(commands, batches.front().queries, geometry);
                  }};
  };
  const std::vector<Method> methods{
      method("standing", still, false, {}), method("standing, all transforms copied", still, true, {}),
      method("all moved", all, false, {.objects = {&moved, 1}}),
      method("all moved, from each other's places", far, false, {.objects = {&moved, 1}})};
  printRows("moved-" + std::to_string(boxes), methods, {&batches.front(), 1}, {.least = 9, .most = 9}, status);
}

void runFlight(const Device& device, int& status) {
  Flight flight;
  // What the host has on its device: the vertices and the transforms as they are, so that the answers are the same.
  std::vector<float> words = flight.mesh().positions;
  const size_t transforms = sizeof(float) * words.size();
  for (const ObjectId id : flight.teapots) {
    for (const double value : flight.standing.object(id).worldFromMesh.m) words.push_back(static_cast<float>(value));
  }
  gpu::Buffer there(device.impl(), "host's", gpu::BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  there.reserve(gpu::bytesOf(words));
  std::memcpy(there.mapped(), words.data(), gpu::bytesOf(words));
  const DeformedMesh deformed{flight.teapot, {.buffer = there.get()}};
  const MovedObjects moved{.transforms = there.get(), .first = transforms, .objects = flight.teapots};

  Recorder standing(device, flight.standing, kCapacity), moving(device, flight.moving, kCapacity),
      unbounded(device, flight.standing, kCapacity);
  gpu::Submission submission(device.impl(), false);
  const auto method = [&](const char* name, Recorder& recorder, HostGeometry geometry, bool throughCpu = false) {
    return Method{name,
                  [&](auto) {
                    submission.submitAndWait();
                    return recorder.read().results;
                  },
                  [&, geometry, throughCpu](uint32_t) {
                    if (throughCpu) flight.show();
                    recorder.record(submission.begin(), flight.batch.queries, geometry);
                  }};
  };
  const std::vector<Method> methods{
      method("standing", standing, {}),
      method("moved", moving, {.objects = {&moved, 1}}),
      method("deformed", moving, {.meshes = {&deformed, 1}}),
      method("deformed, without bounds", unbounded, {.meshes = {&deformed, 1}}),
      method("moved and deformed", moving, {.meshes = {&deformed, 1}, .objects = {&moved, 1}}),
      method("moved and deformed, without bounds", unbounded, {.meshes = {&deformed, 1}, .objects = {&moved, 1}}),
      method("deformed by the CPU", moving, {}, true)};
  printRows("figure7", methods, {&flight.batch, 1}, {.least = 15, .most = 15}, status);
}

}  // namespace

void addRecorded(CLI::App& app, int& status) {
  auto sizes = std::make_shared<std::vector<uint32_t>>(std::vector<uint32_t>{10'000, 600'000});
  CLI::App* command = app.add_subcommand(
      "recorded", "A frame of searches in a host's command buffer: prepare is recording, answer executing");
  command->add_option("--boxes", *sizes, "Objects in scenes in which all are moved")
      ->check(CLI::Range(1u, 10'000'000u))
      ->capture_default_str();
  command->callback([sizes, &status] {
    const Device device = Device::open();
    printHead({&device, 1});
    runFlight(device, status);
    for (const uint32_t boxes : *sizes) runAllMoved(device, boxes, status);
  });
}

}  // namespace radar::bench
