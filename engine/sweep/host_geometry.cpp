#include "sweep/host_geometry.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "spirv/deform_comp.h"
#include "spirv/move_comp.h"
#include "spirv/move_comp_RADAR_NO_DOUBLES.h"
#include "spirv/refit_comp.h"
#include "spirv/refuse_comp.h"
#include "sweep/host_format.h"

// pass    reads                              writes                     barrier behind it
// ------- ---------------------------------- -------------------------- -------------------------------
// copy    staging, the host's buffers        moved, words, stray        transferToComputeReadWrite
// deform  words, meshes                      positions, originals,
//                                            stray
// move    words, moved, meshes, placements   placements, objects,       computeWriteToComputeReadWrite
//                                            stray
// refit   positions, indices, meshes, nodes  nodes                      computeWriteToComputeReadWrite
//
// Behind the answers:
//
// refuse  stray                              results                    before: computeWriteTo-
//                                                                       ComputeReadWrite; the caller's

namespace radar {

using gpu::Residence;

namespace {

constexpr VkDeviceSize kTransformBytes = 48;
constexpr uint32_t kGroup = 64;  ///< invocations in a workgroup of deform, move and refuse

struct Push {
  uint32_t count, groupsX;
  uint32_t mesh = 0;  ///< or how many placements
  uint32_t firstByte = 0, stride = 0, format = 0;
};

std::vector<gpu::Binding> bindingList() {
  std::vector<gpu::Binding> list;
  for (const uint32_t number :
       {gpu::kBindPositions, gpu::kBindOriginals, gpu::kBindIndices, gpu::kBindMeshes, gpu::kBindObjects,
        gpu::kBindNodes, gpu::kBindPlacements, gpu::kBindResults, gpu::kBindWords, gpu::kBindMoved, gpu::kBindStrays}) {
    list.push_back({number, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  }
  return list;
}

std::span<const uint32_t> moveShader(const Device::Impl& device) {
  if (device.doubles) return k_move_comp;
  return k_move_comp_RADAR_NO_DOUBLES;
}

void dispatch(const gpu::Commands& commands, const gpu::Bindings& bindings, const gpu::Pipeline& pipeline,
              uint32_t groups, Push push) {
  if (groups == 0) return;
  push.groupsX = std::min(groups, 65535u);
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (groups + push.groupsX - 1) / push.groupsX, 1);
}

uint32_t groupsFor(uint32_t invocations) {
  return (invocations + kGroup - 1) / kGroup;
}

bool repeats(std::vector<uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

}  // namespace

std::string whatIsWrong(const HostGeometry& geometry, const Scene& scene) {
  std::vector<MeshId> meshes;
  for (const DeformedMesh& deformed : geometry.meshes) {
    const std::string name = "mesh " + std::to_string(deformed.mesh);
    if (!scene.hasMesh(deformed.mesh)) return name + " does not exist";
    if (!scene.impl().meshes[deformed.mesh].deforms) return name + " was added without bounds";
    if (deformed.positions.buffer == VK_NULL_HANDLE) return name + ": expected a buffer of positions";
    if (std::string wrong = whatIsWrong(deformed.positions); !wrong.empty()) return name + ": " + wrong;
    meshes.push_back(deformed.mesh);
  }
  if (repeats(std::move(meshes))) return "meshes: expected each at most once";
  std::vector<ObjectId> objects;
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.transforms == VK_NULL_HANDLE) return "objects: expected a buffer of transforms";
    if (moved.stride < kTransformBytes) {
      return "objects: stride: expected at least 48 bytes, got " + std::to_string(moved.stride);
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

HostGeometryPass::HostGeometryPass(const Device::Impl& device, const ResidentScene& resident)
    : device_(&device),
      resident_(resident),
      bindings_(device, bindingList(), sizeof(Push)),
      deform_(gpu::computePipeline(device, bindings_.layout(), k_deform_comp, "deform")),
      refit_(gpu::computePipeline(device, bindings_.layout(), k_refit_comp, "refit")),
      move_(gpu::computePipeline(device, bindings_.layout(), moveShader(device), "move")),
      refuse_(gpu::computePipeline(device, bindings_.layout(), k_refuse_comp, "refuse")),
      upload_(device),
      words_(device, "words of the host's", Residence::device,
             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      movedBuffer_(device, "moved objects", Residence::device,
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      stray_(device, "stray", Residence::readback,
             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  stray_.reserve(sizeof(gpu::Stray));
}

// Returns where in `words_` the bytes will be.
uint32_t HostGeometryPass::copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
  const VkDeviceSize at = copied_;
  copied_ += gpu::Upload::aligned(bytes);
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  if (copied_ + sizeof(uint32_t) > limit) {
    throw Error("record: the host's geometry takes more than the " + std::to_string(limit) +
                " bytes that this device allows");
  }
  sources_.push_back({buffer, {first, at, bytes}});
  return static_cast<uint32_t>(at);
}

void HostGeometryPass::addMoved(const MovedObjects& objects, const Scene::Impl& scene) {
  if (objects.objects.empty()) return;
  const uint32_t firstByte =
      copyFrom(objects.transforms, objects.first, spanOf(objects.stride, objects.objects.size(), kTransformBytes));
  for (size_t i = 0; i < objects.objects.size(); ++i) {
    const ObjectId id = objects.objects[i];
    const Box& box = *scene.boundsOf(id);
    gpu::Moved moved{.object = id,
                     .mesh = scene.objects[id].object.mesh,
                     .firstByte = static_cast<uint32_t>(firstByte + i * objects.stride)};
    for (int k = 0; k < 3; ++k) {
      moved.anchor[k] = static_cast<float>(0.5 * (box.lo[k] + box.hi[k]));
      moved.halfExtent[k] = downward(std::min(box.hi[k] - moved.anchor[k], moved.anchor[k] - box.lo[k]));
    }
    movedIndex_[id] = static_cast<uint32_t>(moved_.size());
    moved_.push_back(moved);
    bounds_.push_back(box);
  }
}

void HostGeometryPass::stage(const HostGeometry& geometry, const Scene::Impl& scene) {
  sources_.clear();
  copied_ = 0;
  meshes_.clear();
  moved_.clear();
  bounds_.clear();
  movedIndex_.assign(scene.objects.size(), kNone);
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.meshes[deformed.mesh];
    const HostPositions& positions = deformed.positions;
    meshes_.push_back({deformed.mesh, mesh.vertexCount(), static_cast<uint32_t>(mesh.clusters.nodes.size()),
                       copyFrom(positions.buffer, positions.first, spanOf(positions, mesh.vertexCount())),
                       static_cast<uint32_t>(positions.stride), HostFormat(positions.format).component()});
  }
  for (const MovedObjects& objects : geometry.objects) addMoved(objects, scene);
  if (empty()) return;
  words_.reserve(copied_ + sizeof(uint32_t));
  movedBuffer_.reserve(std::max(gpu::bytesOf(moved_), sizeof(gpu::Moved)));
  upload_.begin(gpu::Upload::aligned(gpu::bytesOf(moved_)));
  upload_.add(moved_.data(), gpu::bytesOf(moved_), movedBuffer_);
}

ResidentScene::Overwritten HostGeometryPass::overwritten() const {
  ResidentScene::Overwritten overwritten;
  for (const Deformed& deformed : meshes_) overwritten.meshes.push_back(deformed.mesh);
  for (const gpu::Moved& moved : moved_) overwritten.objects.push_back(moved.object);
  return overwritten;
}

void HostGeometryPass::prepare(ContactPlan& plan) const {
  for (gpu::Placement& placement : plan.placements) {
    if (placement.object == kNone || movedIndex_[placement.object] == kNone) continue;
    placement.moved = movedIndex_[placement.object];
    const float* anchor = moved_[placement.moved].anchor;
    const Vector fromOrigin{anchor[0] - plan.origin[0], anchor[1] - plan.origin[1], anchor[2] - plan.origin[2]};
    for (int row = 0; row < 3; ++row) {
      float* r = &placement.frameFromMesh[4 * row];
      for (int k = 0; k < 3; ++k) r[k] = static_cast<float>(plan.axes[row][k]);
      r[3] = static_cast<float>(dot(plan.axes[row], fromOrigin));
    }
    placement.error = upward(doubleErrorWithin(bounds_[placement.moved], plan.origin));
  }
}

void HostGeometryPass::record(const gpu::Commands& commands, const gpu::Buffer& placements, uint32_t placementCount,
                              const gpu::Buffer& results) {
  upload_.record(commands);
  for (const Source& source : sources_) {
    commands->CmdCopyBuffer(commands, source.buffer, words_.get(), 1, &source.region);
  }
  commands->CmdFillBuffer(commands, stray_.get(), 0, sizeof(gpu::Stray), kNone);
  gpu::transferToComputeReadWrite(commands);
  resident_.bindTo(bindings_);
  bindings_.setBuffer(gpu::kBindNodes, resident_.buffers().nodes);
  bindings_.setBuffer(gpu::kBindPlacements, placements);
  bindings_.setBuffer(gpu::kBindResults, results);
  bindings_.setBuffer(gpu::kBindWords, words_);
  bindings_.setBuffer(gpu::kBindMoved, movedBuffer_);
  bindings_.setBuffer(gpu::kBindStrays, stray_);
  bindings_.bind(commands);
  for (const Deformed& d : meshes_) {
    dispatch(commands, bindings_, deform_, groupsFor(d.vertices),
             {d.vertices, 0, d.mesh, d.firstByte, d.stride, d.component});
  }
  if (!moved_.empty()) {
    const uint32_t count = placementCount + static_cast<uint32_t>(moved_.size());
    dispatch(commands, bindings_, move_, groupsFor(count), {count, 0, placementCount});
  }
  gpu::computeWriteToComputeReadWrite(commands);
  for (const Deformed& d : meshes_) dispatch(commands, bindings_, refit_, d.nodes, {d.nodes, 0, d.mesh});
  gpu::computeWriteToComputeReadWrite(commands);
}

void HostGeometryPass::recordRefusal(const gpu::Commands& commands, uint32_t count) {
  gpu::computeWriteToComputeReadWrite(commands);
  bindings_.bind(commands);
  dispatch(commands, bindings_, refuse_, groupsFor(count), {count, 0});
}

std::string HostGeometryPass::stray() const {
  if (empty()) return {};
  const auto& stray = *reinterpret_cast<const gpu::Stray*>(stray_.mapped());
  if (stray.mesh != kNone) {
    return "mesh " + std::to_string(stray.mesh) + ": vertex " + std::to_string(stray.vertex) +
           " is out of its bounds, or not finite";
  }
  if (stray.object == kNone) return {};
  return "object " + std::to_string(stray.object) +
         ": its mesh's box is out of its bounds, or its transform not finite";
}

}  // namespace radar
