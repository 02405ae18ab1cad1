#include "embed/host_geometry.h"

#include <algorithm>

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

bool repeats(std::vector<uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

}  // namespace

std::string validate(const HostGeometry& geometry, const Scene& scene) {
  std::vector<MeshId> meshes;
  for (const DeformedMesh& deformed : geometry.meshes) {
    std::string name = "mesh " + std::to_string(deformed.mesh);
    if (!scene.hasMesh(deformed.mesh)) return name + " does not exist";
    if (deformed.positions.buffer == VK_NULL_HANDLE) return name + ": expected a buffer of positions";
    if (std::string wrong = validate(deformed.positions); !wrong.empty()) return name.append(": ").append(wrong);
    meshes.push_back(deformed.mesh);
  }
  if (repeats(std::move(meshes))) return "meshes: expected each at most once";
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.transforms == VK_NULL_HANDLE) return "objects: expected a buffer of transforms";
    if (const uint64_t least = extentOf(moved.layout); moved.stride < least) {
      return "objects: stride: expected at least " + std::to_string(least) + " bytes, got " +
             std::to_string(moved.stride);
    }
  }
  return {};
}

HostGeometryPass::HostGeometryPass(const Device::Impl& device, const GpuScene& resident)
    : device_(&device),
      resident_(resident),
      run_(device, {shaders::kDeform, shaders::kRefit, shaders::kInvalidate}),
      upload_(device),
      words_(device, "host words", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      refitNodes_(device, "nodes to refit", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      numbers_(device, "host vertex numbers", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      violation_(device, "bounds violation", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      unboundedMeshes_(device, resident),
      moved_(device, resident) {
  violation_.reserve(1);
}

// Returns the bytes' offset in `words_`.
uint32_t HostGeometryPass::copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
  const VkDeviceSize at = copied_;
  copied_ += gpu::roundedUp(bytes, 8);
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  if (copied_ + sizeof(uint32_t) > limit) {
    throw Error("record: the host's geometry exceeds the " + std::to_string(limit) +
                " bytes of the device's maxStorageBufferRange");
  }
  sources_.push_back({buffer, {first, at, bytes}});
  return static_cast<uint32_t>(at);
}

// Lists the nodes by depth, because a node is refitted after its children.
void HostGeometryPass::listNodes(const Scene::Impl& scene) {
  std::vector<uint64_t> versions;
  for (const Deformed& deformed : meshes_) versions.push_back(scene.meshes[deformed.mesh].version);
  if (versions == listed_) return;
  listed_.clear();
  nodeList_.clear();
  levels_.clear();
  for (const Deformed& deformed : meshes_) {
    const MeshTree& tree = scene.meshes[deformed.mesh].tree;
    std::vector<std::vector<uint32_t>> byDepth(tree.depth);
    std::vector<uint32_t> depths(tree.nodes.size());
    for (uint32_t n = 0; n < depths.size(); ++n) {  // parents before children
      byDepth[depths[n]].push_back(n);
      const uint32_t link = tree.nodes[n].link;
      if ((link & gpu::kLinkLeaf) == 0) depths[link] = depths[link + 1] = depths[n] + 1;
    }
    levels_.resize(std::max(levels_.size(), byDepth.size()));
    for (size_t depth = 0; depth < byDepth.size(); ++depth) {
      levels_[depth].push_back(
          {deformed.mesh, static_cast<uint32_t>(nodeList_.size()), static_cast<uint32_t>(byDepth[depth].size())});
      nodeList_.insert(nodeList_.end(), byDepth[depth].begin(), byDepth[depth].end());
    }
  }
  listed_ = std::move(versions);  // now that all are listed
}

void HostGeometryPass::stage(const HostGeometry& geometry, const Scene::Impl& scene) {
  run_.begin();
  sources_.clear();
  copied_ = 0;
  meshes_.clear();
  vertexNumbers_.clear();
  std::vector<MeshId> unbounded;
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.meshes[deformed.mesh];
    const HostPositions& positions = deformed.positions;
    const uint32_t least = mesh.firstHostVertex, span = mesh.hostVertex(mesh.vertexCount() - 1) - least + 1;
    const bool areListed = !mesh.hostVertices.empty();
    meshes_.push_back(
        {.mesh = deformed.mesh,
         .vertices = mesh.vertexCount(),
         .firstHostVertex = least,
         .firstByte = copyFrom(positions.buffer, positions.first + positions.stride * least, spanOf(positions, span)),
         .stride = static_cast<uint32_t>(positions.stride),
         .component = HostFormat(positions.format).component(),
         .numbers = areListed ? static_cast<uint32_t>(vertexNumbers_.size()) : kNone,
         .isBounded = mesh.deforms});
    for (const uint32_t vertex : mesh.hostVertices) vertexNumbers_.push_back(vertex - least);
    if (!mesh.deforms) unbounded.push_back(deformed.mesh);
  }
  unboundedMeshes_.stage(std::move(unbounded));
  std::vector<uint32_t> firstBytes;
  for (const MovedObjects& moved : geometry.objects) {
    const VkDeviceSize bytes = spanOf(moved.stride, moved.objects.size(), extentOf(moved.layout));
    firstBytes.push_back(moved.objects.empty() ? 0 : copyFrom(moved.transforms, moved.first, bytes));
  }
  moved_.stage(geometry.objects, firstBytes, unboundedMeshes_.meshes(), scene);
  if (empty()) return;
  listNodes(scene);
  words_.reserve(copied_ / sizeof(uint32_t) + 1);
  refitNodes_.reserve(nodeList_.size());
  numbers_.reserve(vertexNumbers_.size());
  upload_.begin();
  upload_.add(nodeList_.data(), gpu::bytesOf(nodeList_), refitNodes_);
  upload_.add(vertexNumbers_.data(), gpu::bytesOf(vertexNumbers_), numbers_);
}

GpuScene::Overwritten HostGeometryPass::overwritten() const {
  GpuScene::Overwritten overwritten;
  for (const Deformed& deformed : meshes_) overwritten.meshes.push_back(deformed.mesh);
  overwritten.moved = moved_.overwritten();
  return overwritten;
}

void HostGeometryPass::record(const gpu::Commands& commands, const Scene::Impl& scene) {
  const GpuScene::Buffers& buffers = resident_.buffers();
  upload_.record(commands);
  unboundedMeshes_.recordUpload(commands);
  moved_.recordUpload(commands);
  for (const Source& source : sources_) {
    commands->CmdCopyBuffer(commands, source.buffer, words_.get(), 1, &source.region);
  }
  commands->CmdFillBuffer(commands, violation_.get(), 0, sizeof(gpu::BoundsViolation), kNone);
  gpu::transferToComputeReadWrite(commands);
  for (const Deformed& d : meshes_) {
    run_(commands, shaders::kDeform, gpu::groupsFor(d.vertices, gpu::kHostGroup),
         gpu::DeformPush{.count = d.vertices,
                         .mesh = d.mesh,
                         .firstByte = d.firstByte,
                         .stride = d.stride,
                         .format = d.component,
                         .numbers = d.numbers,
                         .isBounded = d.isBounded ? 1u : 0u},
         {{gpu::kSlotVertices, buffers.vertices},
          {gpu::kSlotMeshes, buffers.meshes},
          {gpu::kSlotBoundsViolation, violation_},
          {gpu::kSlotVertexNumbers, numbers_},
          {gpu::kSlotWords, words_}});
  }
  if (!unboundedMeshes_.empty()) {
    gpu::computeWriteToComputeReadWrite(commands);
    unboundedMeshes_.recordBound(commands, scene);
  }
  moved_.recordMove(commands, words_, violation_);
  gpu::computeWriteToComputeReadWrite(commands);
  for (size_t depth = meshes_.empty() ? 0 : levels_.size(); depth-- > 0;) {
    for (const Level& level : levels_[depth]) {
      run_(commands, shaders::kRefit, gpu::groupsFor(level.count, gpu::kHostGroup),
           gpu::RefitPush{level.first, level.count, level.mesh},
           {{gpu::kSlotVertices, buffers.vertices},
            {gpu::kSlotTriangles, buffers.triangles},
            {gpu::kSlotMeshes, buffers.meshes},
            {gpu::kSlotMeshNodes, buffers.meshNodes},
            {gpu::kSlotRefitNodes, refitNodes_}});
    }
    gpu::computeWriteToComputeReadWrite(commands);
  }
  moved_.recordFit(commands);
}

void HostGeometryPass::recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results,
                                        uint32_t count) {
  gpu::computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kInvalidate, gpu::groupsFor(count, gpu::kHostGroup), gpu::InvalidatePush{count},
       {{gpu::kSlotResults, results}, {gpu::kSlotBoundsViolation, violation_}});
}

std::string HostGeometryPass::boundsViolation() const {
  if (empty()) return {};
  const gpu::BoundsViolation& violation = *violation_.mapped();
  for (const Deformed& deformed : meshes_) {
    if (violation.mesh != deformed.mesh) continue;
    const uint32_t number =
        deformed.numbers == kNone ? violation.vertex : vertexNumbers_[deformed.numbers + violation.vertex];
    return "mesh " + std::to_string(violation.mesh) + ": vertex " + std::to_string(deformed.firstHostVertex + number) +
           (deformed.isBounded ? " is outside its bounds or not finite" : " is not finite, or exceeds 2^120");
  }
  return violation.object == kNone ? std::string() : moved_.describeViolation(violation.object);
}

}  // namespace radar
