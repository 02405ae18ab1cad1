// Meshes that a host deforms, and objects that it moves, on its device: the answers are those of a scene that has them
// so.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <deque>
#include <random>

#include "embed/on_device.h"
#include "gpu/barrier.h"
#include "gpu/pipeline.h"
#include "radar/recorder.h"
#include "spirv/copy_words_comp.h"
#include "sweep/host_format.h"
#include "sweep/host_geometry.h"
#include "workloads/families.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::append;
using test::execute;
using test::kRoom;
using test::OnDevice;

bool sameBits(const Result& p, const Result& q) {
  return std::memcmp(&p, &q, sizeof(Result)) == 0;
}

/// A box with room around the vertices.
Bounds around(std::span<const float> positions) {
  Bounds bounds{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (size_t i = 0; i < positions.size(); ++i) {
    bounds.lo[i % 3] = std::min(bounds.lo[i % 3], double{positions[i]});
    bounds.hi[i % 3] = std::max(bounds.hi[i % 3], double{positions[i]});
  }
  return bounds;
}

/// The box of a box, placed.
Bounds placed(const Bounds& box, const Pose& pose) {
  Bounds out;
  for (int k = 0; k < 3; ++k) {
    const double* r = &pose.m[4 * static_cast<size_t>(k)];
    double middle = r[3], half = 0;
    for (size_t j = 0; j < 3; ++j) {
      middle += r[j] * 0.5 * (box.lo[j] + box.hi[j]);
      half += std::abs(r[j]) * 0.5 * (box.hi[j] - box.lo[j]);
    }
    out.lo[static_cast<size_t>(k)] = middle - half;
    out.hi[static_cast<size_t>(k)] = middle + half;
  }
  return out;
}

/// A workload as a host has it: the scene knows rest poses and bounds, the host's buffers what is true.
class Hosted {
 public:
  /// The truth's poses become what floats can say. Two meshes of three and every other object are the host's.
  Hosted(tools::Workload& truth, uint32_t seed, Scene& to) : scene(to), random_(seed) {
    tools::replaceBy({.scenes = {{}}}, 0, scene);
    for (const tools::MeshData& mesh : truth.meshes) addMesh(mesh);
    for (tools::Instance& instance : truth.scenes[0].instances) {
      for (double& value : instance.worldFromMesh.m) value = static_cast<float>(value);
      addObject(instance);
    }
    transforms_.emplace_back(transformBytes_);
    moved_.push_back({.transforms = transforms_[0].get(), .first = 16, .stride = 64, .objects = movedIds_});
  }
  HostGeometry geometry() const {
    if (movedIds_.empty()) return {.meshes = deformed_};
    return {.meshes = deformed_, .objects = moved_};
  }

  Scene& scene;

 private:
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random_() >> 8) * 0x1p-24; }

  void addMesh(const tools::MeshData& mesh) {
    if (random_() % 3 == 0) {
      scene.addMesh(mesh.positions, mesh.indices);
      return;
    }
    const Bounds bounds = around(mesh.positions);
    std::vector<float> rest = mesh.positions;
    const bool near = random_() % 2 == 0;
    for (size_t i = 0; i < rest.size(); ++i) {
      const double lo = bounds.lo[i % 3], hi = bounds.hi[i % 3];
      const double value = near ? rest[i] + 0.05 * uniform(lo - hi, hi - lo) : uniform(lo, hi);
      rest[i] = static_cast<float>(std::clamp(value, lo, hi));
    }
    const MeshId id = scene.addMesh(rest, mesh.indices, bounds);
    const size_t first = random_() % 8, stride = 12 + random_() % 9;
    std::vector<std::byte> bytes(first + stride * mesh.vertexCount() + 12);
    for (size_t v = 0; v < mesh.vertexCount(); ++v) {
      std::memcpy(&bytes[first + stride * v], &mesh.positions[3 * v], 12);
    }
    vertices_.emplace_back(bytes);
    deformed_.push_back({id, {.buffer = vertices_.back().get(), .first = first, .stride = stride}});
  }

  void addObject(const tools::Instance& instance) {
    const bool moves = random_() % 2 == 0;
    Object object{instance.mesh, instance.worldFromMesh, ~0u};
    if (moves) object.worldFromMesh.m[3] += 1;
    const ObjectId id = scene.addObject(object);
    if (!moves) return;
    const Mesh& mesh = scene.impl().meshes[instance.mesh];
    Bounds box;
    for (size_t k = 0; k < 3; ++k) {
      box.lo[k] = mesh.centre[k] - mesh.halfExtent[k];
      box.hi[k] = mesh.centre[k] + mesh.halfExtent[k];
    }
    Bounds bounds = placed(box, instance.worldFromMesh);
    // What float arithmetic loses of a mesh far from its origin.
    double magnitude = 0;
    for (size_t i = 0; i < 12; ++i) {
      const double column = i % 4 == 3 ? 1 : std::abs(box.lo[i % 4]) + std::abs(box.hi[i % 4]);
      magnitude = std::max(magnitude, std::abs(instance.worldFromMesh.m[i]) * column);
    }
    const double room = 1e-5 * magnitude + (random_() % 2 == 0 ? 0 : 0.5 * (bounds.hi[0] - bounds.lo[0]));
    for (size_t k = 0; k < 3; ++k) {
      bounds.lo[k] -= room;
      bounds.hi[k] += room;
    }
    scene.setBounds(id, bounds);
    if (movedIds_.empty()) transformBytes_.resize(16);
    transformBytes_.resize(16 + 64 * movedIds_.size());
    for (const double value : instance.worldFromMesh.m) append<float>(transformBytes_, {static_cast<float>(value)});
    movedIds_.push_back(id);
  }

  std::mt19937 random_;
  std::deque<OnDevice> vertices_, transforms_;
  std::vector<std::byte> transformBytes_ = std::vector<std::byte>(16);
  std::vector<ObjectId> movedIds_;
  std::vector<DeformedMesh> deformed_;
  std::vector<MovedObjects> moved_;
};

/// The words of a storage buffer.
std::vector<uint32_t> wordsOf(const gpu::Buffer& buffer, size_t count) {
  const Device::Impl& device = test::device().impl();
  gpu::Bindings bindings(
      device,
      std::array<gpu::Binding, 2>{{{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}}, 4);
  const gpu::Pipeline pipeline = gpu::computePipeline(device, bindings.layout(), k_copy_words_comp, "copy words");
  gpu::Buffer out(device, "words", gpu::Residence::readback, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  out.reserve(4 * count);
  bindings.setBuffer(0, buffer);
  bindings.setBuffer(1, out);
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  bindings.bind(commands);
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdDispatch(commands, static_cast<uint32_t>((count + 63) / 64), 1, 1);
  gpu::writtenToHost(commands);
  submission.submitAndWait();
  std::vector<uint32_t> words(count);
  std::memcpy(words.data(), out.mapped(), 4 * count);
  return words;
}

/// Asks `rounds` scenes of each family.
void meetHosted(uint32_t rounds) {
  Scene truth, scene;
  Sweeper sweeper(test::device(), truth);
  Recorder recorder(test::device(), scene, kRoom);
  size_t hits = 0, answers = 0, refused = 0;
  for (uint32_t i = 0; i < rounds * tools::kFamilies.size(); ++i) {
    const tools::Family family = tools::kFamilies[i % tools::kFamilies.size()];
    const uint32_t seed = 31 + i;
    tools::Workload workload = tools::makeWorkload({.family = family, .queries = kRoom.queries, .seed = seed});
    const Hosted hosted(workload, seed, scene);
    tools::replaceBy(workload, 0, truth);
    std::vector<Query> queries;
    for (const auto& query : workload.queries) queries.push_back(tools::toQuery(query, Mode::contact, 0));
    for (size_t q = 0; q < queries.size(); q += 7) queries[q].decide = true;
    const std::vector<Result> expected = sweeper.run(queries), got = execute(recorder, queries, hosted.geometry());
    for (size_t q = 0; q < queries.size(); ++q) {
      CAPTURE(tools::nameOf(family), seed, q, got[q].flags, got[q].t, expected[q].t);
      ++answers;
      if (got[q].flags != 0) {
        // Rest poses at random make every cluster as large as the mesh: room may run out, and nothing else.
        CHECK((got[q].flags & (kFlagOpen | kFlagClusterPairs | kFlagContenders | kFlagDispatches)) != 0);
        CHECK(got[q].status == (got[q].flags == kFlagOpen ? Status::undecided : Status::invalid));
        if (got[q].flags == kFlagOpen && expected[q].status != Status::clear) CHECK_FALSE(got[q].lo > expected[q].hi);
        ++refused;
      } else if (queries[q].decide) {
        CHECK(got[q].status == expected[q].status);
        CHECK_FALSE(expected[q].lo > got[q].hi);
      } else if (expected[q].tier == Tier::select || got[q].tier == Tier::select) {
        // Bounds reach farther than what is within them: the search may have to find that nothing is there.
        CHECK(got[q].status == expected[q].status);
      } else {
        CHECK(sameBits(got[q], expected[q]));
      }
      hits += got[q].status == Status::hit;
    }
  }
  CHECK(hits > answers / 8);
  CHECK(refused < answers / 20);
  CHECK(test::takeValidationMessages().empty());
}

}  // namespace

TEST_CASE("what a host deforms and moves is met as in a scene that has it so, bit for bit") {
  meetHosted(1);
}

TEST_CASE("what a host deforms and moves is met as in a scene that has it so, in many scenes", "[.][many]") {
  meetHosted(60);
}

TEST_CASE(
    "every 16-bit position comes to the device as it is read while loading, and every cluster holds its vertices") {
  const VkFormat format = GENERATE(VK_FORMAT_R16G16B16_SFLOAT, VK_FORMAT_R16G16B16A16_SNORM, VK_FORMAT_R16G16B16_UNORM);
  const uint32_t vertices = 21846;
  const HostPositions positions{
      .first = 3, .stride = format == VK_FORMAT_R16G16B16A16_SNORM ? 8u : 6u, .format = format};
  std::vector<std::byte> bytes(positions.first + positions.stride * vertices);
  std::vector<float> expected;
  for (uint32_t v = 0; v < vertices; ++v) {
    std::byte* at = &bytes[positions.first + positions.stride * v];
    for (uint32_t k = 0; k < 3; ++k) {
      auto bits = static_cast<uint16_t>(std::min(3 * v + k, 0xffffu));
      if (format == VK_FORMAT_R16G16B16_SFLOAT && (bits & 0x7c00) == 0x7c00)
        bits &= 0x83ff;  // neither infinite nor NaN
      std::memcpy(at + 2 * k, &bits, 2);
      expected.push_back(HostFormat(format).load(at, static_cast<int>(k)));
    }
  }
  Scene scene;
  std::vector<uint32_t> indices(3 * (vertices / 3));
  for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  const MeshId mesh = scene.addMesh(std::vector<float>(expected.size()), indices, around(expected));

  ResidentScene resident(test::device().impl());
  HostGeometryPass pass(test::device().impl(), resident);
  const OnDevice buffer(bytes);
  HostPositions there = positions;
  there.buffer = buffer.get();
  const DeformedMesh deformed{mesh, there};
  const HostGeometry geometry{.meshes = {&deformed, 1}};
  CHECK(whatIsWrong(geometry, scene).empty());
  gpu::Upload upload(test::device().impl());
  upload.begin(resident.prepare(scene.impl()));
  resident.upload(scene.impl(), upload);
  pass.stage(geometry, scene.impl());
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  upload.record(commands);
  pass.record(commands, resident.buffers().meshes, 0, resident.buffers().meshes);
  submission.submitAndWait();

  const std::vector<uint32_t> originals = wordsOf(resident.buffers().originals, expected.size());
  CHECK(std::memcmp(originals.data(), expected.data(), 4 * expected.size()) == 0);
  const std::vector<uint32_t> words = wordsOf(resident.buffers().positions, expected.size());
  std::vector<float> recentred(words.size());
  std::memcpy(recentred.data(), words.data(), 4 * words.size());
  const Mesh& inner = scene.impl().meshes[mesh];
  for (size_t i = 0; i < expected.size(); ++i) {
    const double exact = expected[i] - inner.centre[i % 3];
    if (std::abs(recentred[i] - exact) > 0x1p-23 * std::abs(exact) + 0x1p-126) FAIL("vertex " << i / 3);
  }
  const std::vector<uint32_t> nodeWords =
      wordsOf(resident.buffers().nodes, inner.clusters.nodes.size() * sizeof(gpu::ClusterRecord) / 4);
  size_t leaves = 0;
  for (size_t n = 0; n < inner.clusters.nodes.size(); ++n) {
    gpu::ClusterRecord node;
    std::memcpy(&node, &nodeWords[n * sizeof(node) / 4], sizeof(node));
    for (size_t slot = node.first; slot < node.first + node.count; ++slot) {
      for (size_t i = 0; i < 9; ++i) {
        const size_t vertex = indices[3 * size_t{inner.clusters.order[slot]} + i / 3], k = i % 3;
        if (std::abs(double{recentred[3 * vertex + k]} - node.centre[k]) > node.halfExtent[k]) FAIL("cluster " << n);
      }
    }
    leaves += node.count != 0;
  }
  CHECK(leaves == inner.clusters.leaves);
  CHECK(test::takeValidationMessages().empty());
}
