#include "embed/host_geometry.h"

#include <algorithm>

#include "embed/host_format.h"
#include "embed/host_transforms.h"
#include "gpu/barrier.h"
#include "math/rounding.h"
#include "shaders/contact/interop.h"
#include "spirv/embed_deform_comp.h"
#include "spirv/embed_invalidate_comp.h"
#include "spirv/embed_move_comp.h"
#include "spirv/embed_move_comp_RADAR_NO_DOUBLES.h"
#include "spirv/embed_refit_comp.h"

// pass        reads                         writes                         barrier after it
// ----------- ----------------------------- ------------------------------ -------------------------------
// copy        staging, the host's buffers   moved, words, refit nodes,     transferToComputeReadWrite
//                                           violation
// deform      words, meshes                 vertices, violation            (none)
// move        words, moved, meshes          placements, objects, violation computeWriteToComputeReadWrite
// refit       vertices, triangles, meshes,  nodes                          computeWriteToComputeReadWrite
//   per depth   refit nodes, nodes
//
// After the answers and a computeWriteToComputeReadWrite:
//
// invalidate  violation                     results                        (the caller's)

namespace radar {

using gpu::BufferDomain;

namespace {

// Created once per device.
struct HostGeometryKernels {
  explicit HostGeometryKernels(const Device::Impl& device)
      : deform(device, k_embed_deform_comp, "deform"),
        refit(device, k_embed_refit_comp, "refit"),
        move(device, device.doubles ? std::span<const uint32_t>(k_embed_move_comp) : k_embed_move_comp_RADAR_NO_DOUBLES,
             "move"),
        invalidate(device, k_embed_invalidate_comp, "invalidate") {}
  gpu::Kernel deform, refit, move, invalidate;
};

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
    if (!scene.impl().meshes[deformed.mesh].deforms) return name + " was added without bounds";
    if (deformed.positions.buffer == VK_NULL_HANDLE) return name + ": expected a buffer of positions";
    if (std::string wrong = validate(deformed.positions); !wrong.empty()) return name.append(": ").append(wrong);
    meshes.push_back(deformed.mesh);
  }
  if (repeats(std::move(meshes))) return "meshes: expected each at most once";
  std::vector<ObjectId> objects;
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.transforms == VK_NULL_HANDLE) return "objects: expected a buffer of transforms";
    if (std::string wrong = validate(moved.layout); !wrong.empty()) return "objects: layout: " + wrong;
    if (const uint64_t least = extentOf(moved.layout); moved.stride < least) {
      return "objects: stride: expected at least " + std::to_string(least) + " bytes, got " +
             std::to_string(moved.stride);
    }
    for (const ObjectId object : moved.objects) {
      const std::string name = "object " + std::to_string(object);
      if (!scene.hasObject(object)) return name + " does not exist";
      if (scene.impl().boundsOf(object) == nullptr) return name + " has no bounds: see Scene::setBounds";
      objects.push_back(object);
    }
  }
  if (repeats(std::move(objects))) return "objects: expected each at most once";
  return {};
}

HostGeometryPass::HostGeometryPass(const Device::Impl& device, const GpuScene& resident)
    : device_(&device),
      resident_(resident),
      deform_(device.shared<HostGeometryKernels>().deform),
      refit_(device.shared<HostGeometryKernels>().refit),
      move_(device.shared<HostGeometryKernels>().move),
      invalidate_(device.shared<HostGeometryKernels>().invalidate),
      upload_(device),
      words_(device, "host words", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      refitNodes_(device, "nodes to refit", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      movedBuffer_(device, "moved objects", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      violation_(device, "bounds violation", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  violation_.reserve(1);
}

// Returns the bytes' offset in `words_`.
uint32_t HostGeometryPass::copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
  const VkDeviceSize at = copied_;
  copied_ += gpu::Upload::aligned(bytes);
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  if (copied_ + sizeof(uint32_t) > limit) {
    throw Error("record: the host's geometry exceeds the " + std::to_string(limit) +
                " bytes of the device's maxStorageBufferRange");
  }
  sources_.push_back({buffer, {first, at, bytes}});
  return static_cast<uint32_t>(at);
}

void HostGeometryPass::addMoved(const MovedObjects& objects, const Scene::Impl& scene) {
  if (objects.objects.empty()) return;
  const uint32_t firstByte = copyFrom(objects.transforms, objects.first,
                                      spanOf(objects.stride, objects.objects.size(), extentOf(objects.layout)));
  for (size_t i = 0; i < objects.objects.size(); ++i) {
    const ObjectId id = objects.objects[i];
    const Box& box = *scene.boundsOf(id);
    gpu::Moved moved{.object = id,
                     .mesh = scene.objects[id].object.mesh,
                     .mask = scene.objects[id].object.mask,
                     .firstByte = static_cast<uint32_t>(firstByte + i * objects.stride),
                     .format = encoded(objects.layout)};
    for (int k = 0; k < 3; ++k) {
      moved.anchor[k] = static_cast<float>(0.5 * (box.lo[k] + box.hi[k]));
      moved.halfExtent[k] = roundDown(std::min(box.hi[k] - moved.anchor[k], moved.anchor[k] - box.lo[k]));
    }
    moved_.push_back(moved);
  }
}

// Lists the nodes by depth, because a node is refitted after its children.
void HostGeometryPass::listNodes(const Scene::Impl& scene) {
  std::vector<uint64_t> versions;
  for (const Deformed& deformed : meshes_) versions.push_back(scene.meshes[deformed.mesh].version);
  if (versions == listed_) return;
  listed_ = std::move(versions);
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
}

void HostGeometryPass::stage(const HostGeometry& geometry, const Scene::Impl& scene) {
  sources_.clear();
  copied_ = 0;
  meshes_.clear();
  moved_.clear();
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.meshes[deformed.mesh];
    const HostPositions& positions = deformed.positions;
    const VkDeviceSize first = positions.first + positions.stride * mesh.firstHostVertex;
    meshes_.push_back({deformed.mesh, mesh.vertexCount(), mesh.firstHostVertex,
                       copyFrom(positions.buffer, first, spanOf(positions, mesh.vertexCount())),
                       static_cast<uint32_t>(positions.stride), HostFormat(positions.format).component()});
  }
  for (const MovedObjects& objects : geometry.objects) addMoved(objects, scene);
  if (empty()) return;
  listNodes(scene);
  words_.reserve(copied_ / sizeof(uint32_t) + 1);
  movedBuffer_.reserve(moved_.size());
  refitNodes_.reserve(nodeList_.size());
  upload_.begin(gpu::Upload::aligned(gpu::bytesOf(moved_)) + gpu::Upload::aligned(gpu::bytesOf(nodeList_)));
  upload_.add(moved_.data(), gpu::bytesOf(moved_), movedBuffer_);
  upload_.add(nodeList_.data(), gpu::bytesOf(nodeList_), refitNodes_);
}

GpuScene::Overwritten HostGeometryPass::overwritten() const {
  GpuScene::Overwritten overwritten;
  for (const Deformed& deformed : meshes_) overwritten.meshes.push_back(deformed.mesh);
  for (const gpu::Moved& moved : moved_) overwritten.objects.push_back(moved.object);
  return overwritten;
}

void HostGeometryPass::setArguments() {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& scene = resident_.buffers();
  deform_.set({{kSlotVertices, scene.vertices},
               {kSlotMeshes, scene.meshes},
               {kSlotBoundsViolation, violation_},
               {kSlotWords, words_}});
  refit_.set({{kSlotVertices, scene.vertices},
              {kSlotTriangles, scene.triangles},
              {kSlotMeshes, scene.meshes},
              {kSlotMeshNodes, scene.meshNodes},
              {kSlotRefitNodes, refitNodes_}});
  move_.set({{kSlotMeshes, scene.meshes},
             {kSlotObjects, scene.objects},
             {kSlotPlacements, scene.placements},
             {kSlotMoved, movedBuffer_},
             {kSlotBoundsViolation, violation_},
             {kSlotWords, words_}});
}

void HostGeometryPass::record(const gpu::Commands& commands) {
  upload_.record(commands);
  for (const Source& source : sources_) {
    commands->CmdCopyBuffer(commands, source.buffer, words_.get(), 1, &source.region);
  }
  commands->CmdFillBuffer(commands, violation_.get(), 0, sizeof(gpu::BoundsViolation), kNone);
  gpu::transferToComputeReadWrite(commands);
  setArguments();
  for (const Deformed& d : meshes_) {
    deform_.dispatch(commands, gpu::groupsFor(d.vertices, gpu::kHostGroup),
                     gpu::DeformPush{d.vertices, d.mesh, d.firstByte, d.stride, d.component});
  }
  const auto moved = static_cast<uint32_t>(moved_.size());
  move_.dispatch(commands, gpu::groupsFor(moved, gpu::kHostGroup), gpu::MovePush{moved});
  gpu::computeWriteToComputeReadWrite(commands);
  if (meshes_.empty()) return;
  for (size_t depth = levels_.size(); depth-- > 0;) {
    for (const Level& level : levels_[depth]) {
      refit_.dispatch(commands, gpu::groupsFor(level.count, gpu::kHostGroup),
                      gpu::RefitPush{level.first, level.count, level.mesh});
    }
    gpu::computeWriteToComputeReadWrite(commands);
  }
}

void HostGeometryPass::recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results,
                                        uint32_t count) {
  gpu::computeWriteToComputeReadWrite(commands);
  invalidate_.set({{gpu::kSlotResults, results}, {gpu::kSlotBoundsViolation, violation_}});
  invalidate_.dispatch(commands, gpu::groupsFor(count, gpu::kHostGroup), gpu::InvalidatePush{count});
}

std::string HostGeometryPass::boundsViolation() const {
  if (empty()) return {};
  const gpu::BoundsViolation& violation = *violation_.mapped();
  for (const Deformed& deformed : meshes_) {
    if (violation.mesh != deformed.mesh) continue;
    return "mesh " + std::to_string(violation.mesh) + ": vertex " +
           std::to_string(deformed.firstHostVertex + violation.vertex) + " is outside its bounds or not finite";
  }
  if (violation.object == kNone) return {};
  return "object " + std::to_string(violation.object) +
         ": its mesh's box is outside its bounds, or its transform is not finite";
}

}  // namespace radar
