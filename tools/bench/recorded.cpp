// What a frame costs whose searches are recorded into a host's command buffer: of a scene that stands, one whose
// objects the host moves, one whose mesh it deforms, on its device; and of one whose mesh passes through the CPU. The
// teapots of Figure 7 among their boxes, all ways in turn within one run; medians after a warm-up, without validation
// layers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "commit/commit.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "report/median.h"
#include "scene/scene.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

constexpr int kRepeats = 15;
constexpr Capacity kRoom{.queries = 64, .candidates = 1u << 16, .unresolvedPairs = 1u << 14};

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Way {
  const char* label;
  HostGeometry geometry;
  bool throughCpu = false;
  std::vector<double> recording = {}, executing = {};
  std::vector<Result> results = {};
};

/// Figure 7 as it stands, and as a host has it that moves and deforms the teapots: their bounds with a tenth to spare.
struct Flight {
  Flight() {
    workload = tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1});
    const tools::Batch batch = tools::batchesOf(workload).front();
    for (const uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], Mode::contact));
    teapot = queries[0].mesh;
    tools::replaceBy(workload, batch.scene, standing);
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
    if (moving.objectLimit() == 0) tools::replaceBy(workload, tools::batchesOf(workload).front().scene, moving);
    for (const ObjectId id : teapots) moving.removeObject(id);
    moving.removeMesh(teapot);
    const Box box = boxOf(standing.impl().meshes[teapot], Transform{}.m);
    moving.addMesh(workload.meshes[teapot].positions, workload.meshes[teapot].indices, widened(box));
    for (const ObjectId id : teapots) {
      moving.addObject(standing.object(id));
      moving.setBounds(id, widened(boxOf(moving.impl().meshes[teapot], standing.object(id).worldFromMesh.m)));
    }
  }

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
  std::vector<Query> queries;
  MeshId teapot;
  std::vector<ObjectId> teapots;
  Scene standing, moving;
};

}  // namespace

int main() {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), tools::commit());
  Flight flight;
  // What the host has on its device: the vertices and the transforms as they are, so that the answers are the same.
  const tools::MeshData& mesh = flight.workload.meshes[flight.teapot];
  std::vector<float> words = mesh.positions;
  for (const ObjectId id : flight.teapots) {
    for (const double value : flight.standing.object(id).worldFromMesh.m) words.push_back(static_cast<float>(value));
  }
  gpu::Buffer there(device.impl(), "host's", gpu::BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  there.reserve(gpu::bytesOf(words));
  std::memcpy(there.mapped(), words.data(), gpu::bytesOf(words));
  const DeformedMesh deformed{flight.teapot, {.buffer = there.get()}};
  const MovedObjects moved{.transforms = there.get(), .first = 4 * mesh.positions.size(), .objects = flight.teapots};

  Way ways[] = {{"standing", {}},
                {"moved", {.objects = {&moved, 1}}},
                {"deformed", {.meshes = {&deformed, 1}}},
                {"moved and deformed", {.meshes = {&deformed, 1}, .objects = {&moved, 1}}},
                {"deformed by the CPU", {}, true}};
  Recorder standing(device, flight.standing, kRoom), moving(device, flight.moving, kRoom);
  gpu::Submission submission(device.impl(), false);
  for (int repeat = 0; repeat <= kRepeats; ++repeat) {
    for (Way& way : ways) {
      const bool stands = way.geometry.meshes.empty() && way.geometry.objects.empty() && !way.throughCpu;
      Recorder& recorder = stands ? standing : moving;
      Clock::time_point start = Clock::now();
      if (way.throughCpu) flight.show();
      recorder.record(submission.begin(), flight.queries, way.geometry);
      if (repeat > 0) way.recording.push_back(since(start));
      start = Clock::now();
      submission.submitAndWait();
      if (repeat > 0) way.executing.push_back(since(start));
      way.results = recorder.read();
    }
  }
  std::printf("%zu sensors of %u triangles among as many, and %u boxes; ms a frame\n", flight.queries.size(),
              mesh.triangleCount(), flight.standing.objectLimit() - static_cast<uint32_t>(flight.teapots.size()));
  for (const Way& way : ways) {
    size_t hits = 0, unequal = 0;
    for (size_t i = 0; i < way.results.size(); ++i) {
      hits += way.results[i].status == Status::hit;
      // What is clear may be so by another tier: bounds reach farther than what is within them.
      const Result &p = way.results[i], &q = ways[0].results[i];
      unequal += p.status == Status::clear ? q.status != p.status : std::memcmp(&p, &q, sizeof(Result)) != 0;
    }
    std::printf("  %-20s recording %7.3f  executing %7.3f  of standing %5.2f  (%zu hits, %zu answers differ)\n",
                way.label, tools::median(way.recording), tools::median(way.executing),
                (tools::median(way.recording) + tools::median(way.executing)) /
                    (tools::median(ways[0].recording) + tools::median(ways[0].executing)),
                hits, unequal);
  }
}
