#include "embed/unbounded_meshes.h"

#include <bit>
#include <cmath>

#include "gpu/barrier.h"
#include "math/rounding.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

// Longer lengths are out of range anyway.
constexpr double kLongest = 1e38;

// The float with this number in the order of floats: see normalise.comp.
float floatOf(uint32_t inOrder) {
  return std::bit_cast<float>((inOrder & 0x80000000u) != 0 ? inOrder & 0x7fffffffu : ~inOrder);
}

}  // namespace

gpu::DeformedSensor deformedSensor(uint32_t sensor, const Query& query, const Motion& motion) {
  gpu::DeformedSensor out{.sensor = sensor, .mesh = query.mesh};
  if (query.ignoreLeaving && query.slack) out.slack = roundUp(std::min(2 * *query.slack, kLongest));
  out.clearance = roundUp(std::min(query.clearance, kLongest));
  out.tolerance = roundUp(std::min(query.tolerance.value_or(kLongest), kLongest));
  const double way = motion.wayUntil(motion.distance);
  out.exponent = way > 0 ? std::ilogb(way) : 0;
  const double mantissa = std::ldexp(way, -out.exponent);
  out.way = roundUp(mantissa);
  out.certain = motion.isStep ? roundDown((1 - 0x1p-48) * mantissa) : out.way;
  out.stopBefore = query.anyHit ? std::min(out.certain, roundDown(mantissa)) : -1;
  if (motion.isStep) out.perWay = way > 0 ? roundDown((1 - 0x1p-20) / mantissa) : -1;
  return out;
}

UnboundedMeshesPass::UnboundedMeshesPass(const Device::Impl& device, const GpuScene& resident)
    : resident_(resident),
      run_(device, {shaders::kBound, shaders::kNormalise, shaders::kPlace}),
      upload_(device),
      unbounded_(device, "unbounded meshes", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      extents_(device, "extents", BufferDomain::device,
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      readback_(device, "recorded extents", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      sensors_(device, "deformed sensors", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

void UnboundedMeshesPass::stage(std::vector<MeshId> meshes) {
  run_.begin();
  meshes_.clear();
  push_.count = 0;
  unbounded_.reserve(meshes.size());
  extents_.reserve(meshes.size());
  readback_.reserve(meshes.size());
  meshes_ = std::move(meshes);
}

void UnboundedMeshesPass::stageSensors(std::span<const gpu::DeformedSensor> sensors, const Scene::Impl& scene) {
  if (empty()) return;
  sensors_.reserve(sensors.size());
  upload_.begin();
  upload_.add(meshes_.data(), gpu::bytesOf(meshes_), unbounded_);
  upload_.add(sensors.data(), sensors.size_bytes(), sensors_);
  push_.count = static_cast<uint32_t>(sensors.size());
  setAnchor(push_, scene.objectTree());
}

void UnboundedMeshesPass::recordUpload(const gpu::Commands& commands) const {
  if (empty()) return;
  upload_.record(commands);
  commands->CmdFillBuffer(commands, extents_.get(), 0, VK_WHOLE_SIZE, gpu::kNobody);
}

void UnboundedMeshesPass::recordBound(const gpu::Commands& commands, const Scene::Impl& scene) {
  if (empty()) return;
  using namespace gpu;  // the slots
  const GpuScene::Buffers& buffers = resident_.buffers();
  for (uint32_t i = 0; i < meshes_.size(); ++i) {
    const uint32_t triangles = scene.meshes[meshes_[i]].triangleCount();
    run_(commands, shaders::kBound, groupsFor(triangles, kHostGroup * kBoundRun),
         BoundPush{resident_.record(meshes_[i]).firstTriangle, triangles, i},
         {{kSlotVertices, buffers.vertices}, {kSlotTriangles, buffers.triangles}, {kSlotExtents, extents_}});
  }
  computeWriteToComputeReadWrite(commands);
  const auto count = static_cast<uint32_t>(meshes_.size());
  run_(commands, shaders::kNormalise, groupsFor(count, kHostGroup), NormalisePush{count},
       {{kSlotMeshes, buffers.meshes}, {kSlotUnbounded, unbounded_}, {kSlotExtents, extents_}});
  computeWriteToComputeReadWrite(commands);
}

void UnboundedMeshesPass::recordPlace(const gpu::Commands& commands, const ContactPass& search) {
  if (empty() || push_.count == 0) return;
  const ContactPass::Encoded to = search.encoded();
  run_(commands, shaders::kPlace, gpu::groupsFor(push_.count, gpu::kHostGroup), push_,
       {{gpu::kSlotMeshes, resident_.buffers().meshes},
        {gpu::kSlotObjectNodes, resident_.buffers().objectNodes},
        {gpu::kSlotSensors, to.sensors},
        {gpu::kSlotStates, to.states},
        {gpu::kSlotSweeps, to.sweeps},
        {gpu::kSlotDeformedSensors, sensors_}});
  gpu::computeWriteToComputeReadWrite(commands);
}

void UnboundedMeshesPass::recordReadback(const gpu::Commands& commands) const {
  if (empty()) return;
  const VkBufferCopy all{0, 0, meshes_.size() * sizeof(gpu::Extent)};
  commands->CmdCopyBuffer(commands, extents_.get(), readback_.get(), 1, &all);
}

std::map<MeshId, Box> UnboundedMeshesPass::boxes() const {
  std::map<MeshId, Box> boxes;
  for (size_t i = 0; i < meshes_.size(); ++i) {
    const gpu::Extent& extent = readback_.mapped()[i];
    Box& box = boxes[meshes_[i]];
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = floatOf(extent.lo[k]);
      box.hi[k] = floatOf(~extent.hi[k]);
    }
  }
  return boxes;
}

}  // namespace radar
