#include "embed/host_geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "math/rounding.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;

bool repeats(std::vector<uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

// The float with this number in the order of floats: see normalise.comp.
float floatOf(uint32_t inOrder) {
  return std::bit_cast<float>((inOrder & 0x80000000u) != 0 ? inOrder & 0x7fffffffu : ~inOrder);
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
    if (!moved.objects.empty() && moved.count != 0) return "objects: expected a list or a count, got both";
    if (const uint64_t least = extentOf(moved.layout); moved.stride < least) {
      return "objects: stride: expected at least " + std::to_string(least) + " bytes, got " +
             std::to_string(moved.stride);
    }
  }
  return {};
}

HostGeometryPass::HostGeometryPass(const gpu::Owner& owner, const GpuScene& resident)
    : device_(&owner.device()),
      resident_(resident),
      run_(owner, {shaders::kDeform, shaders::kBound, shaders::kNormalise, shaders::kMove, shaders::kRefit,
                   shaders::kInvalidate}),
      upload_(owner),
      words_(owner, "host words", BufferDomain::device, kUploaded),
      unboundedMeshes_(owner, "unbounded meshes", BufferDomain::device, kUploaded),
      deformedMeshes_(owner, "deformed meshes", BufferDomain::device, kUploaded),
      refitNodes_(owner, "nodes to refit", BufferDomain::device, kUploaded),
      movedObjects_(owner, "moved objects", BufferDomain::device, kUploaded),
      extents_(owner, "extents", BufferDomain::device, kUploaded | VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
      readback_(owner, "recorded extents", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      violation_(owner, "bounds violation", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      tree_(owner) {
  violation_.reserve(1);
}

// Lists what to copy from the host's buffers; returns where `words_` will have the positions of each mesh, then the
// transforms of each group of objects.
std::vector<uint32_t> HostGeometryPass::copyFrom(const HostGeometry& geometry, const Scene::Impl& scene) {
  sources_.clear();
  VkDeviceSize end = 0;
  std::vector<uint32_t> firstBytes;
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  const auto copy = [&](VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
    firstBytes.push_back(static_cast<uint32_t>(end));
    if (bytes == 0) return;
    sources_.push_back({buffer, {first, end, bytes}});
    end = gpu::roundedUp(end + bytes, 8);
    if (end + sizeof(uint32_t) > limit) {
      throw Error("the host's geometry exceeds the " + std::to_string(limit) +
                  " bytes of the device's maxStorageBufferRange");
    }
  };
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.meshes[deformed.mesh];
    const HostPositions& from = deformed.positions;
    copy(from.buffer, from.first + from.stride * mesh.firstHostVertex,
         spanOf(from, mesh.hostVertex(mesh.vertexCount() - 1) + 1));
  }
  for (const MovedObjects& moved : geometry.objects) {
    copy(moved.transforms, moved.first, spanOf(moved.stride, countOf(moved), extentOf(moved.layout)));
  }
  // And the word after the last that a shader may load.
  words_.reserve(end / sizeof(uint32_t) + 1);
  return firstBytes;
}

void HostGeometryPass::stage(const HostGeometry& geometry, const Scene::Impl& scene) {
  run_.begin();
  tree_.begin();
  upload_.begin();
  const bool isEmpty = geometry.meshes.empty() && std::ranges::all_of(geometry.objects, [](const MovedObjects& moved) {
                         return countOf(moved) == 0;
                       });
  if (isEmpty) {
    deformed_ = {};
    moved_ = {};
    return;
  }
  const std::vector<uint32_t> firstBytes = copyFrom(geometry, scene);
  const auto ofMeshes = std::span(firstBytes).first(geometry.meshes.size());
  update(deformed_, geometry, ofMeshes, scene);
  update(moved_, geometry, std::span(firstBytes).subspan(ofMeshes.size()), deformed_.unbounded, scene);
  if (!deformed_.isUploaded) stageDeformed();
  if (!moved_.isUploaded) stageMoved();
}

void HostGeometryPass::stageDeformed() {
  deformedMeshes_.reserve(deformed_.meshes.size());
  refitNodes_.reserve(deformed_.refitNodes.size());
  unboundedMeshes_.reserve(deformed_.unbounded.size());
  extents_.reserve(deformed_.unbounded.size());
  readback_.reserve(deformed_.unbounded.size());
  upload_.add(deformed_.meshes.data(), gpu::bytesOf(deformed_.meshes), deformedMeshes_);
  upload_.add(deformed_.refitNodes.data(), gpu::bytesOf(deformed_.refitNodes), refitNodes_);
  upload_.add(deformed_.unbounded.data(), gpu::bytesOf(deformed_.unbounded), unboundedMeshes_);
}

void HostGeometryPass::stageMoved() {
  movedObjects_.reserve(moved_.moved.size());
  upload_.add(moved_.moved.data(), gpu::bytesOf(moved_.moved), movedObjects_);
  tree_.stage(moved_.parts, upload_);
}

GpuScene::Overwritten HostGeometryPass::overwritten() const {
  GpuScene::Overwritten overwritten{.meshes = {}, .moved = moved_.overwritten};
  for (const gpu::Deformed& deformed : deformed_.meshes) overwritten.meshes.push_back(deformed.mesh);
  return overwritten;
}

void HostGeometryPass::record(const gpu::Commands& commands, const Scene::Impl& scene, uint32_t searches) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& to = resident_.buffers();
  upload_.record(commands);
  for (const Source& source : sources_) {
    commands->CmdCopyBuffer(commands, source.buffer, words_.get(), 1, &source.region);
  }
  commands->CmdFillBuffer(commands, violation_.get(), 0, sizeof(BoundsViolation), kNobody);
  const auto unbounded = static_cast<uint32_t>(deformed_.unbounded.size());
  if (unbounded != 0) commands->CmdFillBuffer(commands, extents_.get(), 0, VK_WHOLE_SIZE, kNobody);
  tree_.recordFills(commands);
  transferToComputeReadWrite(commands);
  const auto meshes = static_cast<uint32_t>(deformed_.meshes.size());
  run_(commands, shaders::kDeform, deformed_.groups[kByDeform], DeformedPush{meshes, deformed_.groups[kByDeform]},
       {{kSlotVertices, to.vertices},
        {kSlotMeshes, to.meshes},
        {kSlotBoundsViolation, violation_},
        {kSlotWords, words_},
        {kSlotDeformed, deformedMeshes_}});
  if (unbounded != 0) {
    computeWriteToComputeReadWrite(commands);
    run_(commands, shaders::kBound, deformed_.groups[kByBound], DeformedPush{meshes, deformed_.groups[kByBound]},
         {{kSlotVertices, to.vertices},
          {kSlotTriangles, to.triangles},
          {kSlotMeshes, to.meshes},
          {kSlotExtents, extents_},
          {kSlotDeformed, deformedMeshes_}});
    computeWriteToComputeReadWrite(commands);
    run_(commands, shaders::kNormalise, groupsFor(unbounded, kHostGroup), NormalisePush{unbounded},
         {{kSlotMeshes, to.meshes}, {kSlotUnbounded, unboundedMeshes_}, {kSlotExtents, extents_}});
    computeWriteToComputeReadWrite(commands);
  }
  if (!moved_.moved.empty()) {
    MovePush push{.count = static_cast<uint32_t>(moved_.moved.size())};
    setAnchor(push, scene.objectTree());
    run_(commands, shaders::kMove, groupsFor(push.count, kHostGroup), push,
         {{kSlotMeshes, to.meshes},
          {kSlotObjects, to.objects},
          {kSlotPlacements, to.placements},
          {kSlotObjectNodes, to.objectNodes},
          {kSlotMoved, movedObjects_},
          {kSlotBoundsViolation, violation_},
          {kSlotWords, words_}});
  }
  computeWriteToComputeReadWrite(commands);
  // Depth by depth, the deepest first.
  for (size_t depth = deformed_.refitEnds.size(); depth-- > 0;) {
    const uint32_t first = depth == 0 ? 0 : deformed_.refitEnds[depth - 1], count = deformed_.refitEnds[depth] - first;
    run_(commands, shaders::kRefit, groupsFor(count, kHostGroup), RefitPush{first, count},
         {{kSlotVertices, to.vertices},
          {kSlotTriangles, to.triangles},
          {kSlotMeshes, to.meshes},
          {kSlotMeshNodes, to.meshNodes},
          {kSlotRefitNodes, refitNodes_}});
    computeWriteToComputeReadWrite(commands);
  }
  tree_.record(commands, to.objectNodes, static_cast<uint32_t>(scene.objectTree().nodes().size()), searches);
  computeWriteToComputeReadWrite(commands);
}

void HostGeometryPass::recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results,
                                        uint32_t count) {
  gpu::computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kInvalidate, gpu::groupsFor(count, gpu::kHostGroup), gpu::InvalidatePush{count},
       {{gpu::kSlotResults, results}, {gpu::kSlotBoundsViolation, violation_}});
}

void HostGeometryPass::recordReadback(const gpu::Commands& commands) const {
  if (deformed_.unbounded.empty()) return;
  const VkBufferCopy all{0, 0, deformed_.unbounded.size() * sizeof(gpu::Extent)};
  commands->CmdCopyBuffer(commands, extents_.get(), readback_.get(), 1, &all);
}

std::map<MeshId, Box> HostGeometryPass::unboundedBoxes() const {
  std::map<MeshId, Box> boxes;
  for (size_t i = 0; i < deformed_.unbounded.size(); ++i) {
    const gpu::Extent& extent = readback_.mapped()[i];
    Box& box = boxes[deformed_.unbounded[i]];
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = floatOf(extent.lo[k]);
      box.hi[k] = floatOf(~extent.hi[k]);
    }
  }
  return boxes;
}

std::string HostGeometryPass::boundsViolation() const {
  if (empty()) return {};
  const gpu::BoundsViolation& violation = *violation_.mapped();
  for (size_t i = 0; i < deformed_.meshes.size(); ++i) {
    const gpu::Deformed& deformed = deformed_.meshes[i];
    if (violation.mesh != deformed.mesh) continue;
    return "mesh " + std::to_string(violation.mesh) + ": vertex " +
           std::to_string(deformed_.firstHostVertices[i] + violation.vertex) +
           (deformed.extent == gpu::kNobody ? " is outside its bounds or not finite"
                                            : " is not finite, or exceeds 2^120");
  }
  if (violation.object == kNone) return {};
  return "object " + std::to_string(violation.object) +
         (std::ranges::binary_search(unbounded(), violation.object)
              ? ": its transform is not finite, or floats cannot hold its box"
              : ": its mesh's box is outside its bounds, or its transform is not finite");
}

}  // namespace radar
