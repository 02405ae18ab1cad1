#include <algorithm>
#include <cstring>

#include "embed/recorder.h"
#include "gpu/submission.h"
#include "proof/checks.h"
#include "proof/known_scene.h"
#include "radar/cpu_sweeper.h"

namespace radar {

namespace {

// What a host has on its device.
template <class T>
gpu::Buffer bufferOf(const Device::Impl& device, const std::vector<T>& elements) {
  gpu::Buffer buffer(device, "a host's", gpu::BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  buffer.reserve(gpu::bytesOf(elements));
  std::memcpy(buffer.mapped(), elements.data(), gpu::bytesOf(elements));
  return buffer;
}

std::vector<float> floatsOf(const Transform& pose) {
  return {pose.m.begin(), pose.m.end()};
}

HostQuery hostQueryOf(const Query& query) {
  HostQuery written{.distance = static_cast<float>(query.distance),
                    .mesh = query.mesh,
                    .mask = query.mask,
                    .exclude = query.exclude.empty() ? kNone : query.exclude[0],
                    .flags = query.anyHit ? HostQuery::kAnyHit : 0};
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), written.worldFromMesh);
  std::copy(query.direction.begin(), query.direction.end(), written.direction);
  return written;
}

// The known scene, of which the recorder's scene knows neither where most objects are nor how two meshes are shaped.
class HostsScene {
 public:
  HostsScene(const Device::Impl& device, const KnownScene& known) {
    for (const MeshId mesh : known.meshes) {
      const MeshView view = known.scene.mesh(mesh);
      std::vector<float> rest(view.positions.begin(), view.positions.end());
      if (mesh % 2 == 1) {
        buffers_.push_back(bufferOf(device, rest));
        deformed_.push_back({mesh, {.buffer = buffers_.back().get()}});
        for (float& x : rest) x = 0.75f * x + 1;
      }
      scene.addMesh(rest, view.indices);
    }
    std::vector<float> poses;
    for (ObjectId id = 0; id < known.scene.objectLimit(); ++id) {
      Object object = known.scene.object(id);
      if (id % 4 != 0) {
        const std::vector<float> pose = floatsOf(object.worldFromMesh);
        poses.insert(poses.end(), pose.begin(), pose.end());
        moved_.push_back(id);
        for (size_t row = 0; row < 3; ++row) object.worldFromMesh.m[4 * row + 3] += 5;
      }
      scene.addObject(object);
    }
    buffers_.push_back(bufferOf(device, poses));
    group_ = {.transforms = buffers_.back().get(), .objects = moved_};
    scene.setBounds(1, {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}});
  }
  HostGeometry geometry() const { return {.meshes = deformed_, .objects = {&group_, 1}}; }

  Scene scene;

 private:
  std::vector<gpu::Buffer> buffers_;
  std::vector<DeformedMesh> deformed_;
  std::vector<ObjectId> moved_;
  MovedObjects group_;
};

}  // namespace

std::vector<AnswerCheck> checkRecorder(const Device::Impl& device, uint64_t seed) {
  const KnownScene known(seed);
  const HostsScene hosts(device, known);
  constexpr Capacity kRoom{
      .queries = 24, .candidates = 1u << 15, .rounds = 64, .unresolvedPairs = 1u << 13, .searches = 24 * 32};
  Recorder::Impl recorder(device, hosts.scene, std::make_shared<GpuScene>(device), kRoom);
  std::vector<Query> queries = known.queries;
  CpuSweeper cpu(known.scene);
  const auto check = [&](const char* kind, const auto& asked) {
    return orAllWrong(kind, queries.size(), [&] {
      gpu::Submission submission(device, false);
      recorder.record(submission.begin(), asked, hosts.geometry());
      submission.submitAndWait();
      return compared(kind, recorder.read().results, cpu.run(queries).results, true);
    });
  };
  for (size_t i = 0; i < queries.size(); i += 3) queries[i].hits = queries[i].anyHit ? 1 : 3;
  std::vector<AnswerCheck> checks{check("recordings of a host's geometry", queries)};
  // Shaders write neither lists nor what ignores leaving, and exclude one object.
  std::vector<HostQuery> written;
  for (Query& query : queries) {
    query.hits = 1;
    query.ignoreLeaving = false;
    query.slack.reset();
    written.push_back(hostQueryOf(query));
  }
  const gpu::Buffer buffer = bufferOf(device, written);
  checks.push_back(check("queries of a host's shaders",
                         HostQueries{.buffer = buffer.get(), .count = static_cast<uint32_t>(written.size())}));
  return checks;
}

}  // namespace radar
